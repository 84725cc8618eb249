# Results of a sweep against the first key that varies, with error bars and, dashed, what is expected; a color for each combination of the other keys. A ring is a verdict other than PASS. Where a seed varies, the line goes through
# the means over the seeds and the bars are their spread.
load sprintf("< awk -f common/figures/sweep.awk '%s'", table)
