# compare_foot.gp: the table under the histories of compare.gp.
unset logscale; unset title; unset xlabel; unset ylabel; unset border; unset tics; unset grid; unset key
set lmargin at screen 0; set rmargin at screen 1; set bmargin at screen 0; set tmargin at screen 1; set xrange [0:1]; set yrange [0:1]
do for [line = 0:results - 1] {
    text = system(table.sprintf(" | sed -n %dp", line + 1))
    do for [k = 1:5] {
        set label 10 * line + k word(text, k) noenhanced at screen real(word('0.22 0.41 0.60 0.84 0.985', k)), screen (foot_high - 20.0 - 30 * line) / high right font ',15'
    }
}
plot -1 lc rgb 'white'
