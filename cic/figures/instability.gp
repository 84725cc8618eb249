# instability.gp: the page that instabilities share, phase space at some times above the growth of the field and, unless a script names another last_panel to
# load, the energies. A script sets heading and what phase_row.gp and growth.gp ask for.
if (!exists('last_panel')) last_panel = 'cic/figures/energies.gp'
marks = times
row_bottom = 0.545; row_top = 0.875
set multiplot title heading font ',24'
load 'cic/figures/phase_row.gp'
set bmargin at screen 0.1; set tmargin at screen 0.42
set lmargin at screen 0.085; set rmargin at screen 0.53
load 'cic/figures/growth.gp'
set lmargin at screen 0.62; set rmargin at screen 0.97
load last_panel
unset multiplot
