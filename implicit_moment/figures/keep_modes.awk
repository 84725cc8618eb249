# keep_modes.awk: the part of one column of a fields file that has wave numbers m_low to m_high along its first
# direction, as rows "x z part". -v column=C -v m_low=A -v m_high=B
function finish(    m, i, a, b, part) {
    n = count - 1   # the last point is the first of the next period
    if (n < 1) return
    for (i = 0; i <= n; ++i) part[i] = 0
    for (m = m_low; m <= m_high && 2 * m < n; ++m) {
        a = b = 0
        for (i = 0; i < n; ++i) {
            a += f[i] * cos(turn * m * i / n)
            b += f[i] * sin(turn * m * i / n)
        }
        for (i = 0; i <= n; ++i) part[i] += (a * cos(turn * m * i / n) + b * sin(turn * m * i / n)) * 2 / n
    }
    for (i = 0; i <= n; ++i) print x[i], z, part[i]
    count = 0
}
BEGIN { turn = 8 * atan2(1, 1); count = 0 }
$1 + 0 != $1 { next }
count > 0 && $2 != z { finish() }
{ z = $2; x[count] = $1; f[count] = $column; ++count }
END { finish() }
