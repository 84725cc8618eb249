# The cost slide, measured: the time that explicit_em takes to unit flux of the GEM challenge, over that of implicit_moment, against the mass ratio. Points:
# this machine, full where steps were timed, open where the time of a particle-step is carried over from m_i/m_e = 100. Line: the formula of the slide, (m_i/m_e)^{3/2}.
load 'common/style.gp'
table = run.'/cost.dat'
set title 'what an explicit run costs, in implicit ones'
set xlabel 'm_i / m_e'; set ylabel 'explicit / implicit'
set logscale xy; set format y '10^{%T}'
set xrange [15:3000]; set yrange [30:2e6]
set key top left
set xtics (25, 100, 400, 1836)
plot x**1.5 @theory title 'formula of the slide, (m_i/m_e)^{3/2}', \
     table using ($1 == 25 ? $1 : NaN):(456) with points pt 2 ps 2 lw 2.4 lc rgb ink title 'runs of the slide: 456 in particle-steps', \
     table using 1:13 with linespoints lt 3 pt 8 ps 1.6 title 'particle-steps', \
     table using 1:14 with lines lt 1 title 'time', \
     table using ($12 == 1 ? $1 : NaN):14 with points pt 7 ps 1.8 lc rgb blue title 'time, steps timed', \
     table using ($12 == 0 ? $1 : NaN):14 with points pt 6 ps 1.8 lw 2 lc rgb blue title 'time, extrapolated'
