# Figure 15 of the talk: mean velocity along the current at t Ω_{ci} = 12 (averaged over 11 to 13, with T_i/T_e = 10 over 11 to 12, and over the seeds) for four temperature ratios, over v_i = (2 T_i/m_i)^(1/2).
# The talk does not say whose; it is read as that of the ions, which start with u_i = v_i. Their mean starts lower at the edges, because
# the resting background counts, too; the instability slows them there a little more. Right: the electrons, which start with -(T_e/T_i) u_i.
# from: implicit_moment/data/thin_sheet_velocity.csv
wide = 1500; high = 720
load 'common/style.gp'
if (!exists('kept')) kept = 'implicit_moment/data'
set datafile separator ','
data = kept.'/thin_sheet_velocity.csv'
ratios = '10 4 2 1'; dashes = '1 3 2 4'   # solid, dotted, dashed, dash-dotted, as in the talk
background = 0.01
start(x) = 1 / (1 + background * cosh(x)**2)   # mean of the drifting sheet and the resting background
set multiplot layout 1, 2 title 'Thin current sheet: mean velocity along the current at t Ω_{ci} = 12' font ',22' margins 0.09, 0.985, 0.15, 0.85 spacing 0.09, 0
set xrange [-3:3]; set xtics 1
set xlabel 'z / L'
do for [c = 3:4] {
    set title (c == 3 ? 'ions' : 'electrons') offset 0, -0.6
    set ylabel (c == 3 ? 'v_{y,i} / v_i' : 'v_{y,e} / v_i') offset 1, 0
    if (c == 3) { set key bottom center samplen 3 title 'T_i / T_e' } else { unset key }
    plot [-3:3] (c == 3 ? start(x) : NaN) with lines lt 7 dt 2 title 't = 0', for [n = 1:4] sprintf("< awk -F, '$1 == %s' %s", word(ratios, n), data) using 2:c with lines lt n dt int(word(dashes, n)) title word(ratios, n)
}
unset multiplot
