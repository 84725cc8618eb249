# What the figures of the thin current sheet share. They use the talk's letters: y along the current, z across the sheet, x along B;
# in files y is called x, and x is -y.
# A number of the [current_sheet] of a run's complete input.
sheet(name) = real(system(sprintf("LC_ALL=C awk -v name='%s' '/^\\[/ { here = $1 == \"[current_sheet]\" } here && $1 == name { print $3 }' '%s/case.toml'", name, run)))
half_width(ratio, drift) = sqrt(ratio / (1 + ratio)) / drift   # L in d_i
# All profiles of a run, one after the other; and column c of them as a mean over a while:  plot profile(folder, 4, 6.5, 7.5) using 1:2
# columns: 1 t Omega_ci   2 z/L   3 B_y/B0   4 J_x/J_0   5 n_i/n0   6 n_e/n0   7 v_i   8 v_e   [(2 T_i/m_i)^(1/2)]
profiles(folder) = sprintf("< cat '%s'/profile_*.dat", folder)
profile(folder, c, begin, end) = sprintf("< cat '%s'/profile_*.dat | LC_ALL=C awk '$1 + 0 == $1 && $1 >= %g - 1e-6 && $1 <= %g + 1e-6 { sum[$2] += $%d; count[$2]++ } END { for (z in sum) print z, sum[z] / count[z] }' | sort -g", folder, begin, end, c)
