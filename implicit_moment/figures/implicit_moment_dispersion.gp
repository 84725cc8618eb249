# Numerical dispersion and damping of light waves (left) and cold Langmuir waves (right): points are runs of the program, curves the exact factor g per step of
# the theta scheme. theta = 1/2 never damps and slows the wave like 2 atan(a/2)/a; theta = 1 removes what the time step cannot resolve
# (beyond omega_p dt = 4 its Langmuir wave does not oscillate any more).
wide = 1500; high = 900
load 'common/style.gp'
i = {0, 1}
light(theta, a) = (1 + i * a * (1 - theta)) / (1 - i * a * theta)
# (g - 1)^2 = -(W^2/2)(1 + g)(theta g + 1 - theta) as  a g^2 - 2 b g + d = 0
A(theta, W) = 1 + 0.5 * W**2 * theta
B(W) = 1 - 0.25 * W**2
D(theta, W) = 1 + 0.5 * W**2 * (1 - theta)
plasma(theta, W) = (B(W) + sqrt(B(W)**2 - A(theta, W) * D(theta, W) + i * 0)) / A(theta, W)
frequency(g, a) = abs(arg(g)) / a
file(wave, theta) = sprintf('%s/%s_%s.dat', run, wave, theta)
set logscale x; set xrange [0.08:6]
set samples 400
set multiplot layout 2, 2 margins 0.085, 0.985, 0.12, 0.91 spacing 0.075, 0.09
unset xlabel; set format x ''
set yrange [0:1.08]; set ylabel 'ω / ω(Δt → 0)' offset 1, 0
set title 'light wave in vacuum'
set key bottom left
plot frequency(light(0.5, x), x) with lines lt 1 title 'θ = 1/2, exact for the scheme', file('light', '0.5') using 1:($2 * $4 * $6 / $1) with points pt 7 ps 1.4 lc rgb blue title 'runs', \
     frequency(light(1.0, x), x) with lines lt 2 title 'θ = 1', file('light', '1') using 1:($2 * $4 * $6 / $1) with points pt 5 ps 1.3 lc rgb orange notitle
set title 'cold Langmuir wave'
unset key; set ylabel ''
plot frequency(plasma(0.5, x), x) with lines lt 1, file('langmuir', '0.5') using 1:($2 * $4 * $6 / $1) with points pt 7 ps 1.4 lc rgb blue, \
     (x < 4 ? frequency(plasma(1.0, x), x) : NaN) with lines lt 2, file('langmuir', '1') using 1:($1 < 4 ? $2 * $4 * $6 / $1 : NaN) with points pt 5 ps 1.3 lc rgb orange
unset title
set format x '%g'
set xlabel 'c Δt K'; set ylabel '|g| per step' offset 1, 0
plot abs(light(0.5, x)) with lines lt 1, file('light', '0.5') using 1:(exp(-$3 * $6)) with points pt 7 ps 1.4 lc rgb blue, \
     abs(light(1.0, x)) with lines lt 2, file('light', '1') using 1:(exp($3 * $5 * $6)) with points pt 5 ps 1.3 lc rgb orange
set xlabel 'ω_p Δt'; set ylabel ''
plot abs(plasma(0.5, x)) with lines lt 1, file('langmuir', '0.5') using 1:(exp(-$3 * $6)) with points pt 7 ps 1.4 lc rgb blue, \
     (x < 4 ? abs(plasma(1.0, x)) : NaN) with lines lt 2, file('langmuir', '1') using 1:($1 < 4 ? exp($3 * $5 * $6) : NaN) with points pt 5 ps 1.3 lc rgb orange
unset multiplot
