# columns.awk: the columns of a data file of a run as lines "number name unit"; the unit of a pure number is 1.
FNR == 1 { columns = split($0, name) }
FNR == 2 && sub(/^# units: */, "") {
    pairs = split($0, pair, / *, */)
    for (i = 1; i <= pairs; i++) {
        key = unit_of = pair[i]
        sub(/ .*/, "", key)
        sub(/^[^ ]* */, "", unit_of)
        unit[key] = unit_of
    }
}
FNR == 3 { exit }
END { for (i = 1; i <= columns; i++) print i, name[i], name[i] in unit ? unit[name[i]] : 1 }
