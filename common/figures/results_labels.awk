# results_labels.awk: the table of results.awk as labels of gnuplot, one line for each result, and its expected value.
function short(text) { return text ~ /^[<>]/ ? substr(text, 1, 1) " " sprintf("%.4g", substr(text, 2)) : sprintf("%.4g", text) }
NR > 1 {
    says = $2 == "null" ? "" : sprintf("%.6g", $2) ($3 == "-" ? "" : " ± " sprintf("%.2g", $3)) ($7 == "-" || $7 == 1 ? "" : " " $7)
    if ($4 != "-") says = says "   expected " short($4) ($5 == "-" ? "" : " ± " short($5))
    color = $6 == "PASS" ? "green" : $6 == "-" ? "ink" : "orange"
    gsub(/_/, " ", $6)
    printf "set label %d '%s' at graph -0.03, first %d right noenhanced font ',15'\n", 3 * NR, $1, NR - 1
    printf "set label %d '%s' at graph 1.04, first %d left noenhanced font ',15' textcolor rgb %s\n", 3 * NR + 1, says, NR - 1, color
    if ($6 != "-") printf "set label %d '%s' at screen 0.985, first %d right noenhanced font ',15' textcolor rgb %s\n", 3 * NR + 2, $6, NR - 1, color
}
