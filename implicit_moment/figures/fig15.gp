# Figure 15 of the talk: mean velocity along the current at t Ω_{ci} = 12 (averaged over the last 0.5) for four temperature ratios, over v_i = (2 T_i/m_i)^(1/2).
# The talk does not say whose; it is read as that of the ions, which start with u_i = v_i. Their mean starts lower at the edges, because
# the resting background counts, too; the instability slows them there a little more. Right: the electrons, which start with -(T_e/T_i) u_i.
wide = 1500; high = 720
load 'common/style.gp'
load 'implicit_moment/figures/thin_sheet.gp'
ratios = '10 4 2 1'; dashes = '1 3 2 4'   # solid, dotted, dashed, dash-dotted, as in the talk
series = run; run = series.'/ratio_1'; n_b = sheet('background'); run = series
start(x) = 1 / (1 + n_b * cosh(x)**2)   # mean of the drifting sheet and the resting background
set multiplot layout 1, 2 title 'Thin current sheet: mean velocity along the current at t Ω_{ci} = 12' font ',22' margins 0.09, 0.985, 0.15, 0.85 spacing 0.09, 0
set xrange [-3:3]; set xtics 1
set xlabel 'z / L'
do for [c = 7:8] {
    set title (c == 7 ? 'ions' : 'electrons') offset 0, -0.6
    set ylabel (c == 7 ? 'v_{y,i} / v_i' : 'v_{y,e} / v_i') offset 1, 0
    if (c == 7) { set key bottom center samplen 3 title 'T_i / T_e' } else { unset key }
    plot [-3:3] (c == 7 ? start(x) : NaN) with lines lt 7 dt 2 title 't = 0', for [n = 1:4] profile(run.'/ratio_'.word(ratios, n), c, 11.5, 12) using 1:2 with lines lt n dt int(word(dashes, n)) title word(ratios, n)
}
unset multiplot
