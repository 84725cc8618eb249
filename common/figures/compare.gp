# Two runs on one page: the histories, solid the first and dashed the second, and their results beside each other, with what is expected.
table = sprintf("sh common/figures/compare.sh '%s' '%s'", run, other)
results = int(system(table.' | wc -l'))
foot_high = 60 + 30 * results
foot = 'common/figures/compare_foot.gp'
load sprintf("< sh common/figures/history.sh '%s' '%s'", run, other)
