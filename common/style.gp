# style.gp: the one look of all figures. A figure script begins with
#   load 'common/style.gp'
# and is run from the project's root with the variables
#   run   the folder of the run, e.g. 'out/implicit_moment/gem'
#   out   the picture to draw; its ending says how: .png (default), .svg or .pdf
# Before loading, a script may set  wide  and  high  (pixels; 1300 x 820 without).

if (!exists("out"))  out = 'figure.png'
if (!exists("wide")) wide = 1300
if (!exists("high")) high = 820

ending = out[strlen(out) - 2 : strlen(out)]
if (ending eq 'svg') {
    set terminal svg size wide, high font 'DejaVu Sans,20' enhanced rounded background rgb 'white'
} else { if (ending eq 'pdf') {
    set terminal pdfcairo size wide / 100.0, high / 100.0 font 'DejaVu Sans,14' enhanced rounded
} else {
    set terminal pngcairo size wide, high font 'DejaVu Sans,20' enhanced rounded
} }
set encoding utf8
set output out

# A run that has not come to its end, and how far it has come (plot.sh).
if (exists('ended') && ended ne '') {
    if (exists('heading')) { heading = heading.ended } else { set label 99 ended[3:*] noenhanced at screen 0.995, screen 0.018 right front font ',15' textcolor rgb '#D55E00' }
    ended = ''
}

# ---- the frame: two thin axes, a faint grid behind the data -------------------------------------
ink = '#333333'
faint = '#e4e4e4'
set border 3 linewidth 1.2 linecolor rgb ink
set tics nomirror out scale 0.6 textcolor rgb ink
set grid back linetype 1 linewidth 0.7 linecolor rgb faint
set key Left reverse samplen 2 spacing 1.2 textcolor rgb ink
set title font ',22' textcolor rgb ink

# ---- lines: Okabe and Ito's colors, which stay apart for color-blind readers ---------------------
blue = '#0072B2'
orange = '#D55E00'
green = '#009E73'
pink = '#CC79A7'
amber = '#E69F00'
sky = '#56B4E9'
yellow = '#F0E442'
gray = '#777777'
set linetype 1 linewidth 2.4 linecolor rgb blue pointtype 7
set linetype 2 linewidth 2.4 linecolor rgb orange pointtype 5
set linetype 3 linewidth 2.4 linecolor rgb green pointtype 9
set linetype 4 linewidth 2.4 linecolor rgb pink pointtype 13
set linetype 5 linewidth 2.4 linecolor rgb amber pointtype 11
set linetype 6 linewidth 2.4 linecolor rgb sky pointtype 15
set linetype 7 linewidth 2.4 linecolor rgb gray pointtype 1
set linetype 8 linewidth 2.4 linecolor rgb 'black' pointtype 2
set linetype cycle 8

# Clauses of a plot command:  plot 'history.dat' using 1:2 @measured title 'this run'
measured  = "with lines linetype 1"
theory    = "with lines linetype 2 dashtype 2"
published = "with points pointtype 6 pointsize 1.2 linewidth 2 linecolor rgb ink"
band      = "with filledcurves fillstyle transparent solid 0.18 noborder"
dots      = "with points pointtype 7 pointsize 0.12"
contours  = "with lines linewidth 1.2 linecolor rgb '#50204060'"

# ---- colors of a field:  eval colors(viridis)  or  eval signed(range) -----------------------------
# Sampled perceptually uniform maps; the last is for fields with a sign, its middle is zero.
viridis = "0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725'"
inferno = "0 '#000004', 1 '#1b0c41', 2 '#4a0c6b', 3 '#781c6d', 4 '#a52c60', 5 '#cf4446', 6 '#ed6925', 7 '#fb9b06', 8 '#f7d13d', 9 '#fcffa4'"
# Light enough for dark lines on it.
oranges = "0 '#fffaf3', 1 '#fee6ce', 2 '#fdd0a2', 3 '#fdae6b', 4 '#fd8d3c', 5 '#e6550d', 6 '#b63c00', 7 '#7f2704'"
diverging = "-4 '#053061', -3 '#2166ac', -2 '#4393c3', -1 '#92c5de', 0 '#f7f7f7', 1 '#f4a582', 2 '#d6604d', 3 '#b2182b', 4 '#67001f'"
colors(map) = "set palette defined (" . map . ")"
signed(range) = sprintf("%s; set cbrange [%g:%g]", colors(diverging), -range, range)

# A picture of a field needs a full frame, true proportions, no grid and room for its color box:
#   eval field_frame; plot 'fields_000100.dat' using 1:2:3 with image notitle
field_frame = "unset grid; set border 15; set size ratio -1; set tics out"

# Contours of a field file (columns x z f...) as lines to draw over an image (axes without numbers would leave no numbers in the lines):
#   eval contours_of(run.'/fields_000100.dat', '1:2:5', 'levels incremental -2, 0.2, 2', '$lines')
#   plot ... with image, $lines using 1:2 @contours notitle
contours_of(file, columns, levels, block) = \
    "set format xy '%g'; set contour base; unset surface; set cntrparam " . levels . "; set table " . block . \
    "; splot '" . file . "' using " . columns . "; unset table; unset contour; set surface"

# ---- numbers of the run ----------------------------------------------------------------------------
# result('flux_initial') is the number that the program compared with theory; any other entry of
# summary.json by its path, e.g. entry('performance.wall_s').
entry(path) = system(sprintf("awk -v key='%s' -f common/json_lines.awk '%s/summary.json'", path, run))
result(name) = real(entry('results.' . name . '.value'))
# parameter('dt'): a number of the run's complete input, case.toml.
parameter(name) = real(system(sprintf("awk -v name='%s' '$1 == name && $2 == \"=\" { print $3; exit }' '%s/case.toml'", name, run)))
# given('grain.left.radius') by its section; with a * for a name, as in given('grain.*.radius'), the first that there is. Text stays text.
given(path) = system(sprintf("awk -v path='%s' 'BEGIN { gsub(/[.]/, \"[.]\", path); gsub(/[*]/, \"[^.]*\", path) } /^\\[/ { gsub(/[][]/, \"\"); section = $1 } $2 == \"=\" && section \".\" $1 ~ \"^\" path \"$\" { sub(/^[^=]*= */, \"\"); gsub(/\"/, \"\"); print; exit }' '%s/case.toml'", path, run))

# Labels of an axis in units of pi:  set xtics pi; eval pi_tics('x', 4)
pi_tics(axis, n) = sprintf("set %stics ('0' 0, 'π' pi", axis) . \
    (n < 2 ? '' : ", '2π' 2*pi") . (n < 3 ? '' : ", '3π' 3*pi") . (n < 4 ? '' : ", '4π' 4*pi") . ")"

# The number of a named column of a table, whose first line holds the names:  plot file using (column(col(file, 'time'))):...  or
#   t = col(file, 'time'); plot file using t:(column(t + 1))
col(file, name) = int(system(sprintf("awk -v name='%s' '{ for (i = 1; i <= NF; i++) if ($i == name) print i; exit }' '%s'", name, file)))

# The first number in a named column of a history.
first(file, name) = real(system(sprintf("awk -v name='%s' 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) c = i } NR > 1 && $1 + 0 == $1 { print $c; exit }' '%s'", name, file)))

# The time of a snapshot, fields_000400.dat or another.
time_of(file) = real(system(sprintf("awk '/^# time/ { print $3; exit }' '%s'", file)))

# ---- the snapshots that a run has --------------------------------------------------------------------
# times_of('fields', 4): four of its times, or as many as there are; near('fields', '10 20'): of its times the nearest to these, with a note where they differ;
# file_at('fields', 10): the file that is nearest to a time.
times_of(kind, count) = system(sprintf("sh common/snapshots.sh some '%s' %s %d", run, kind, count))
near(kind, wanted) = system(sprintf("sh common/snapshots.sh near '%s' %s '%s'", run, kind, wanted))
file_at(kind, time) = system(sprintf("sh common/snapshots.sh file '%s' %s %.12g", run, kind, time))
