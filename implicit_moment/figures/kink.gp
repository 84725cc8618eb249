# What the figures of the kink share. They use the talk's letters: y along the current, z across the sheet, x along B; in files y is called x, and
# the talk's B_x is -B_y.
ratios = '4 2 1'
folder(ratio) = sprintf('%s/ratio_%s', run, ratio)
last_fields(ratio) = system(sprintf("ls '%s'/fields_*.dat | tail -n 1", folder(ratio)))
# A number of the complete input of one of the runs, and of its results.
input(ratio, name) = real(system(sprintf("LC_ALL=C awk '/^\\[/ { here = $1 == \"[current_sheet]\" || $1 == \"[time]\" } here && $1 == \"%s\" { print $3 }' '%s/case.toml'", name, folder(ratio))))
found(ratio, name) = real(system(sprintf("LC_ALL=C awk -v key=results.%s.value -f common/json_lines.awk '%s/summary.json' || echo nan", name, folder(ratio))))
