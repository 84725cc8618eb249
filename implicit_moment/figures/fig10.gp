# Figure 10 of the talk: electron v_x, ion density, ion v_x and B_z along z = 0 in the GEM challenge when the reconnected flux is one. Published profiles (Pritchett
# 2001, which the talk compares with) could not be had in digital form; the dashed reference is this project's own explicit run at the slide's numbers.
# Averaged from unit flux on for 0.6/Ω_ci (a-c), at unit flux (d); x is measured from the X-line of each run. Electrons leave the X-line first
# and faster than the ions, and the sheet there has lost most of its density.
# fits: implicit_moment|explicit_em file:profile.dat result:density_at_X_line
wide = 1500; high = 940
load 'common/style.gp'
implicit = run.'/profile.dat'
explicit = 'implicit_moment/data/explicit_gem_profile.csv'
set datafile separator ' ,'   # profile.dat has blanks, the explicit run's data commas
set xrange [-12.8:12.8]; set xtics -12, 4
set multiplot layout 2, 2 margins 0.09, 0.985, 0.12, 0.91 spacing 0.09, 0.07 \
    title 'GEM challenge at unit flux, along z = 0' font ',22'
panel(letter, name) = sprintf("set label 1 '(%s)' at graph 0.015, 0.95; set ylabel '%s' offset 0.5, 0", letter, name)
profiles = "plot explicit using 1:column @theory title 'explicit', implicit using 1:column @measured title 'implicit moment'"
unset xlabel; set format x ''
unset key
column = 2; eval panel('a', 'electron v_x / v_A'); eval profiles
column = 3; eval panel('b', 'ion density / n_0'); set yrange [0:1.8]; set key bottom left; eval profiles
unset key
set xlabel 'x / d_i'; set format x '%g'; set yrange [*:*]
column = 4; eval panel('c', 'ion v_x / v_A'); eval profiles
column = 5; eval panel('d', 'B_z / B_0'); eval profiles
unset multiplot
