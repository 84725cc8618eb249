# Figure 12 of the talk: E_y of the lower-hybrid drift instability in the plane of current (y) and gradient (z), T_i/T_e = 4. Left, when it saturates, eight
# waves fill the box at both edges of the sheet; middle, the talk's time, t Ω_{ci} = 7, as it is, and what of it has wave numbers within
# a quarter of that of the largest mode; right, the growth of that mode beside local kinetic theory.
# fits: implicit_moment file:fields_*.dat result:dominant_mode result:growth_over_theory
wide = 2100; high = 760
load 'common/style.gp'
# The talk's letters: y along the current, z across the sheet; in files y is called x.
sheet(name) = real(given('current_sheet.'.name))
B0 = 1 / sheet('light_over_alfven'); L = sqrt(sheet('temperature_ratio') / (1 + sheet('temperature_ratio'))) / sheet('drift'); length = sheet('length_x')
history = run.'/history.dat'
m = int(result('dominant_mode') + 0.5)
times = near('fields', sprintf('%g %g', result('time_of_saturation') / B0, 7 / B0))   # 7/Ω_{ci} is the talk's time
E = col(file_at('fields', 0), 'E_x')
set multiplot title sprintf('Lower-hybrid drift instability: the largest mode has m_y = %d, k_y L = %.1f  (talk: 8, 12.5)', m, result('dominant_k_L')) font ',22'

eval field_frame
unset key
set size noratio
eval signed(2); set cbtics 1
filtered(t) = sprintf("< LC_ALL=C awk -v column=%d -v m_low=%d -v m_high=%d -f implicit_moment/figures/keep_modes.awk '%s'", E, ceil(0.75 * m), floor(1.25 * m), file_at('fields', t))
set xrange [0:length]; set yrange [-3:3]
set xtics 0, 1, length - 0.5; set ytics 1
set xlabel 'y / L'
do for [panel = 1:3] {
    t = real(word(times, panel == 1 ? 1 : words(times)))
    left = 0.037 + 0.195 * (panel - 1)
    set lmargin at screen left; set rmargin at screen left + 0.185
    set bmargin at screen 0.14; set tmargin at screen 0.83
    set title (panel < 3 ? sprintf('E_y at t Ω_{ci} = %.2g', t * B0) : sprintf('the same, m_y = %d to %d', ceil(0.75 * m), floor(1.25 * m))) offset 0, -0.6
    if (panel == 1) { set ylabel 'z / L' offset 1.5, 0; unset colorbox } else { unset ylabel; set format y '' }
    if (panel == 3) { set colorbox user origin 0.618, 0.14 size 0.009, 0.69; set cblabel 'E_y c / (B_0 v_A)' offset 1, 0 }
    if (panel < 3) { plot file_at('fields', t) skip 1 using ($1 / L + 0.5 * length):($2 / L):(column(E) / B0**2) with image notitle }
    else { plot filtered(t) using ($1 / L + 0.5 * length):($2 / L):($3 / B0**2) with image notitle }
}

unset colorbox; set format y '10^{%L}'; set border 3; set grid
set lmargin at screen 0.745; set rmargin at screen 0.985
set title 'edges, 0.75 L < |z| < 1.75 L' offset 0, -0.6
set xrange [0:7]; set yrange [2e-3:5]; set logscale y; set ytics auto; set xtics 1
set xlabel 't Ω_{ci}'; set ylabel 'amplitude of E_y c / (B_0 v_A)' offset 1, 0
set key top left samplen 1.5
t = col(history, 'time_Omega_ci')
part(edge) = col(history, sprintf('%s_%d_re', edge, m))
u = part('upper'); l = part('lower')
gamma = result('growth_over_theory') * result('theory_growth')
omega = result('omega_over_theory') * result('theory_omega')
size(a, b, c, d) = sqrt(0.5 * (a**2 + b**2 + c**2 + d**2))
# Largest amplitude, and when half of it is first reached: there the slope of theory is drawn.
largest = system(sprintf("LC_ALL=C awk '$1 + 0 == $1 && $%d <= 7 { t[++n] = $%d; a[n] = sqrt(0.5*($%d^2+$%d^2+$%d^2+$%d^2)); if (a[n] > top) top = a[n] } END { for (k = 1; a[k] < top / 2; ++k); print top, t[k] }' '%s'", t, t, u, u + 1, l, l + 1, history))
top = real(word(largest, 1)); half = real(word(largest, 2))
set label 1 sprintf('γ = %.1f Ω_{ci}  (local theory %.1f)', gamma, result('theory_growth')) at 1.75, 0.0078 textcolor rgb ink font ',17'
set label 2 sprintf('ω = %.1f Ω_{ci}  (local theory %.1f)', omega, result('theory_omega')) at 1.75, 0.0046 textcolor rgb ink font ',17'
plot history using t:(size(column(u), column(u + 1), column(l), column(l + 1))) @measured title sprintf('m_y = %d', m), \
     [half - 1.5:half + 0.5] top * exp(result('theory_growth') * (x - half - 0.2)) @theory title 'slope of local theory'
unset multiplot
