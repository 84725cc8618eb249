# panels.gp: begins a page of as many panels as `panels` says, three in a row, under `heading`.
across = panels < 3 ? panels : 3
rows = (panels + across - 1) / across
if (!exists('foot_high')) foot_high = 0   # room for what foot draws
wide = 600 * across; high = 125 + 490 * rows + foot_high
load 'common/style.gp'
set multiplot layout rows, across title heading noenhanced font ',24' \
    margins 0.22 / across, 1 - 0.08 / across, (100.0 + foot_high) / high, 1 - 115.0 / high spacing 0.32 / across, 165.0 / high
set key top left maxrows 4 samplen 1.2 spacing 1 width 0 font ',14'
set title font ',18'; set xlabel font ',17' offset 0, 0.3; set ylabel font ',17'; set tics font ',17'
