# polariscope.gp: grains as they look in a circular polariscope with a dark field. A figure script sets
#   f_sigma   the stress difference of one fringe [E]: the unit of the fringe order N = (s1 - s2) / f_sigma
# loads this file after common/style.gp, and draws a file of write_fringes in one of two lights:
#   eval in_one_color;   plot run.'/fringes_000100.dat' @one_color notitle
#   eval in_white_light; plot run.'/fringes_000100.dat' @white_light notitle
# Each eval sets the panel's frame; after the last one, eval daylight brings back the house's.
#
# One color: I = sin^2 (pi N), dark where N = 0, 1, 2 ..., of a lamp whose light is one part in a hundred
# wide: beyond some twenty fringes, next to a contact, they merge into gray.
# White light: the same for every wavelength, with the retardation N x 550 nm, so that
# I = sin^2 (pi N 550 nm / wavelength); the eye adds them up. N = 0 is black; then come white, yellow,
# red, blue, green as in a chart of Michel-Levy, and paler colors with every order.
if (!exists("f_sigma")) f_sigma = 1.0

# What little light crossed polarizers let through shows unloaded grains before the black background.
if (!exists("leak")) leak = 0.012

# ---- white light: a table of red, green and blue for N = 0 ... 16 ---------------------------------------
# Color-matching functions of the eye: Wyman, Sloan and Shirley, J. Computer Graphics Techniques 2 (2), 1 (2013).
lobe(l, at, below, above) = exp(-0.5 * ((l - at) / (l < at ? below : above))**2)
eye_X(l) = 1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) - 0.065 * lobe(l, 501.1, 20.4, 26.2)
eye_Y(l) = 0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1)
eye_Z(l) = 1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8)
# Into the primaries of a screen (sRGB), each scaled so that light of all wavelengths alike is white; paler
# than the eye sees them, for the purest colors are outside of what a screen can show.
tint = 0.78
array screen_R[31]; array screen_G[31]; array screen_B[31]
all_R = 0; all_G = 0; all_B = 0
do for [n = 1:31] {
    l = 390 + 10 * n
    screen_R[n] = tint * (3.2406 * eye_X(l) - 1.5372 * eye_Y(l) - 0.4986 * eye_Z(l)) + (1 - tint) * eye_Y(l)
    screen_G[n] = tint * (-0.9689 * eye_X(l) + 1.8758 * eye_Y(l) + 0.0415 * eye_Z(l)) + (1 - tint) * eye_Y(l)
    screen_B[n] = tint * (0.0557 * eye_X(l) - 0.2040 * eye_Y(l) + 1.0570 * eye_Z(l)) + (1 - tint) * eye_Y(l)
    all_R = all_R + screen_R[n]; all_G = all_G + screen_G[n]; all_B = all_B + screen_B[n]
}
# A screen's 0 ... 255 for a part of white, with the exposure of a photograph.
if (!exists("exposure")) exposure = 1.05
shown(part) = 255 * (part <= 0.0031308 ? 12.92 * (part > 0 ? part : 0) : part >= 1 ? 1 : 1.055 * part**(1 / 2.4) - 0.055)
seen(light) = shown(exposure * (leak + (1 - leak) * light))
through(N, l) = sin(pi * N * 550.0 / l)**2
orders = 16; per_order = 100
array white_R[orders * per_order + 1]; array white_G[orders * per_order + 1]; array white_B[orders * per_order + 1]
do for [k = 1:orders * per_order + 1] {
    N = (k - 1.0) / per_order
    white_R[k] = seen((sum [n = 1:31] screen_R[n] * through(N, 390 + 10 * n)) / all_R)
    white_G[k] = seen((sum [n = 1:31] screen_G[n] * through(N, 390 + 10 * n)) / all_G)
    white_B[k] = seen((sum [n = 1:31] screen_B[n] * through(N, 390 + 10 * n)) / all_B)
}
entry_of(N) = N < 0 ? 1 : 1 + (N < orders ? int(N * per_order + 0.5) : orders * per_order)

# ---- the clauses of a plot command; column 5 is -1 between the grains ------------------------------------
contrast(N) = N < 60 ? exp(-2 * (pi * 0.01 * N)**2) : 0
dark_field(N) = leak + (1 - leak) * 0.5 * (1 - contrast(N) * cos(2 * pi * N))
one_color = "using 1:2:($5 < 0 ? 0 : dark_field($3 / f_sigma)) with image"
white_light = "using 1:2:($5 < 0 ? 0 : white_R[entry_of($3 / f_sigma)]):($5 < 0 ? 0 : white_G[entry_of($3 / f_sigma)]):($5 < 0 ? 0 : white_B[entry_of($3 / f_sigma)]) with rgbimage"

in_white_light = "unset grid; unset key; unset colorbox; set size ratio -1; set border 15 back; set tics out; set object 99 rectangle from graph 0, graph 0 to graph 1, graph 1 fillcolor rgb 'black' fillstyle solid noborder behind"
in_one_color = in_white_light . "; set palette gray gamma 1.7; set cbrange [0:1]"
daylight = "unset object 99; set border 3 front; set size noratio; set grid; set key; set colorbox"

# ---- a scale of the orders N = (s1 - s2) / f_sigma, last in a multiplot: set the margins of its panel, eval scale_of_orders,
#      and plot '++' @orders_in_one_color notitle, or @orders_in_white_light
if (!exists("most_orders")) most_orders = 4
scale_of_orders = "unset object 1; unset title; unset xlabel; unset ylabel; unset xtics; unset x2tics; unset ytics; set size noratio; set xrange [0:1]; set yrange [0:most_orders]; set y2range [0:most_orders]; set y2tics 1 format '%g'; set samples 2; set isosamples 2, 400"
orders_in_one_color = "using 1:2:(dark_field($2)) with image"
orders_in_white_light = "using 1:2:(white_R[entry_of($2)]):(white_G[entry_of($2)]):(white_B[entry_of($2)]) with rgbimage"
