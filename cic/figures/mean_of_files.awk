# mean_of_files.awk: the mean of tables of the same shape, row by row, over the files whose number is at least FIRST:
#   awk -v first=15000 -f cic/figures/mean_of_files.awk RUN/fields_*.dat
FNR == 1 { taken = (substr(FILENAME, length(FILENAME) - 9, 6) + 0 >= first + 0); files += taken }
taken && NF && $1 + 0 == $1 { for (i = 1; i <= NF; i++) sum[FNR, i] += $i; columns[FNR] = NF; if (FNR > rows) rows = FNR }
END {
    for (row = 1; row <= rows; row++) {
        for (i = 1; i <= columns[row]; i++) printf("%s%.6g", (i > 1 ? " " : ""), sum[row, i] / files)
        print ""
    }
}
