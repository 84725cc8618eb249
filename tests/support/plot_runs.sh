#!/bin/sh
# plot_runs.sh BUILD some|all|own|tools [CASE ...]: runs draw without an edit: pictures of sane size, and no word of gnuplot.
#   some, all   shipped cases, cut to a few steps with a few snapshots
#   own         three cases of a user, run to the end, with the figures that fit them
#   tools       comparing, watching, animating and sweeping
set -u
export LC_ALL=C.UTF-8 OMP_NUM_THREADS=1
build=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM
status=0
complain() { echo "$*" >&2; status=1; }

# A PNG of a size that a picture with something on it has.
is_picture() { [ -f "$1" ] && [ "$(wc -c < "$1")" -gt 6000 ] && head -c 4 "$1" | grep -q PNG; }

# draws RUN PICTURE...: draws the run, quietly but for notes; these pictures are among them.
draws() {
    run=$1
    shift
    PLOTS=$folder/plots sh common/plot.sh "$run" > "$folder/told" 2> "$folder/errors" || complain "$run: status $?"
    grep -v '^note: ' "$folder/errors" && complain "$run: gnuplot or a script complained"
    [ "$(wc -l < "$folder/told")" -ge 2 ] || complain "$run: fewer than two figures"
    for picture; do grep -q "/$picture.png\$" "$folder/told" || complain "$run has no figure $picture"; done
    for picture in $(sed -n 's/^figure: //p' "$folder/told"); do is_picture "$picture" || complain "$run: $picture is no picture"; done
    rm -rf "$folder/plots"
}

program_of() {
    case $1 in
    */sphere_hits_plate.toml) echo pic ;;
    implicit_moment/cases/*explicit*) echo explicit_em ;;
    *) echo "${1%%/*}" ;;
    esac
}

# Twelve steps of a case, with snapshots of all kinds that its program has.
draw_case() {
    program=$build/$(program_of "$1")
    dt=$("$program" "$1" --dry-run 2>/dev/null | sed -n 's/^ *steps.* of \(dt = \)\{0,1\}\([0-9.e+-]*[0-9]\).*/\2/p')
    set -- "$1" "time.end=$(awk "BEGIN { print 12 * $dt }")"
    for kind in fields particles phase fringes grains profile; do
        "$program" --help | grep -q "^  output.${kind}_interval" && set -- "$@" "output.${kind}_interval=$(awk "BEGIN { print 4 * $dt }")"
    done
    # Large packs need no fine rasters here.
    "$program" --help | grep -q '^  output.pixels_per_cell' && set -- "$@" output.pixels_per_cell=2
    rm -rf "$folder/run"
    # Some comparisons refuse to be cut short.
    "$program" "$@" --quiet --threads 1 --out "$folder/run" > "$folder/said" 2>&1 ||
        "$program" "$@" theory.compare=none --quiet --threads 1 --out "$folder/run" > "$folder/said" 2>&1 ||
        { complain "$1: status $?: $(cat "$folder/said")"; return; }
    rm -rf "${folder:?}/$(basename "$1" .toml)"
    mv "$folder/run" "$folder/$(basename "$1" .toml)"
    draws "$folder/$(basename "$1" .toml)" history
    rm -rf "${folder:?}/$(basename "$1" .toml)"
}

case $2 in
some)
    for case in cic/cases/two_stream.toml cic/cases/diocotron.toml flip/cases/sod.toml flip/cases/sphere_hits_plate.toml flip/cases/dam_break.toml \
        mpm_explicit/cases/rebound.toml mpm_explicit/cases/diametral_disk.toml mpm_implicit/cases/shear.toml implicit_moment/cases/gem.toml \
        implicit_moment/cases/explicit_weibel.toml; do
        draw_case $case
    done
    ;;
all)
    shift 2
    [ $# -gt 0 ] || set -- ./*/cases/*.toml
    for case; do draw_case "${case#./}"; done
    ;;
own)
    # Two streams, longer, on another mesh, of species with other names, and snapshots at other times.
    cat > "$folder/beams.toml" <<'EOD'
[grid]
cells_x = 48
length_x = 9
[time]
dt = 0.07
end = 100
[species.east]
density = 0.5
drift_x = 1
loading = "lattice"
particles_per_cell = 40
amplitude = 1e-4
[species.west]
density = 0.5
drift_x = -1
loading = "lattice"
particles_per_cell = 40
[species.background]
charge = 1
motion = "fixed"
density = 1
[theory]
compare = "wave"
[output]
particles_interval = 11
EOD
    "$build/cic" "$folder/beams.toml" --quiet --out "$folder/beams" 2>/dev/null || complain "beams: status $?"
    draws "$folder/beams" history results particles instability
    [ "$(sh common/snapshots.sh near "$folder/beams" particles '20 33 50 1000' 2>/dev/null | awk '{ print NF, ($2 - 33 < 1), ($4 > 90) }')" = '4 1 1' ] ||
        complain "beams: the times of the snapshots are not those of the run"
    # The line of theory lies on the wave at the end of the fit.
    until=$(awk -v key=results.growth.source -f common/json_lines.awk "$folder/beams/summary.json" | sed 's/.* to \([0-9.]*\).*/\1/')
    sh common/figures/history.sh "$folder/beams" | sed -n 's/.*exp(\([^ ]*\) + \([^ ]*\) [*] x).*/\1 \2/p' | awk -v until="$until" '
        NR == FNR { height = $1; rate = $2; next }
        FNR == 1 { for (i = 1; i <= NF; i++) place[$i] = i }
        $1 + 0 == $1 && $1 <= until { off = height + rate * $1 - 0.5 * log($place["mode_re"] ^ 2 + $place["mode_im"] ^ 2) }
        END { exit !(off && off ^ 2 < 0.01) }' - "$folder/beams/history.dat" || complain "beams: the line of theory is beside the wave"
    # A Riemann problem.
    cat > "$folder/tube.toml" <<'EOD'
[grid]
cells_x = 80
length_x = 2
[time]
end = 0.3
[boundary]
x_low = "slip"
x_high = "slip"
[setup]
kind = "riemann"
interface = 0.8
[left]
density = 2
pressure = 3
[right]
density = 0.5
pressure = 0.4
[theory]
compare = "riemann"
[output]
fields_interval = 0.1
particles_interval = 0.1
EOD
    "$build/flip" "$folder/tube.toml" --quiet --out "$folder/tube" 2>/dev/null || complain "tube: status $?"
    draws "$folder/tube" history results profile fields
    sh common/figures/snapshots.sh "$folder/tube" particles | grep -q "title 'left'.*title 'right'" || complain "tube: the particles of the two gases have no key"
    # What walls absorb and emit is no error of the energy.
    "$build/cic" cic/cases/sheath.toml time.end=2 theory.compare=none --quiet --out "$folder/sheath" 2>/dev/null || complain "sheath: status $?"
    sh common/figures/history.sh "$folder/sheath" | grep -q 'charge._error' || complain "sheath: the history lacks the error of the charge"
    sh common/figures/history.sh "$folder/sheath" | grep -q 'energy._drift' && complain "sheath: energy between open walls is said to be 0"
    # Four grains.
    cat > "$folder/grains.toml" <<'EOD'
[grid]
cells_x = 40
cells_y = 40
length_x = 1
[time]
end = 0.3
[material.default]
E = 1e4
nu = 0.3
density = 1000
[grain.a]
x = 0.3
y = 0.3
radius = 0.12
velocity_x = 0.3
[grain.b]
x = 0.7
y = 0.3
radius = 0.12
[grain.c]
x = 0.3
y = 0.7
radius = 0.1
velocity_y = -0.3
[grain.d]
x = 0.7
y = 0.7
radius = 0.14
velocity_x = -0.2
[output]
particles_interval = 0.06
fringes_interval = 0.15
EOD
    "$build/mpm_explicit" "$folder/grains.toml" --quiet --out "$folder/grains" 2>/dev/null || complain "grains: status $?"
    draws "$folder/grains" history particles fringes
    ;;
tools)
    for cells in 32 64; do
        "$build/flip" flip/cases/sod.toml grid.cells_x=$cells output.particles_interval=0.05 --quiet --out "$folder/$cells" 2>/dev/null
    done
    PLOTS=$folder/plots sh common/plot.sh compare "$folder/32" "$folder/64" > "$folder/told" 2>&1 || complain "compare: $(cat "$folder/told")"
    is_picture "$(echo "$folder"/plots/compare_flip--*--32_flip--*--64.png)" || complain "comparing two runs drew nothing"
    sh common/figures/compare.sh "$folder/32" "$folder/64" | grep -q '^L1_density [0-9.]* [0-9.]* 0±[0-9.]*,0±[0-9.]* PASS$' || complain "comparing does not show what is expected of each run"
    # Of a run that has ended it draws once.
    PLOTS=$folder/plots sh common/plot.sh watch "$folder/32" > "$folder/told" 2>&1 || complain "watch: $(cat "$folder/told")"
    is_picture "$folder/plots/history.png" || complain "watching drew nothing"
    TEXT=1 sh common/plot.sh watch "$folder/32" 2>&1 | grep -q kinetic || complain "watching in text showed no energy"
    PLOTS=$folder/plots sh common/plot.sh movie "$folder/32" > "$folder/told" 2>&1 || complain "movie: $(cat "$folder/told")"
    for movie in "$folder"/plots/particles.mp4 "$folder"/plots/particles.gif; do [ -s "$movie" ] && found=yes; done
    [ "${found:-}" ] || complain "there is no animation"
    sh common/plot.sh "$folder" 2>/dev/null
    [ $? = 2 ] || complain "a folder that is no run was not refused"
    # A damaged history is refused in one sentence; one whose last line is in the making is not.
    damage() {
        rm -rf "$folder/damaged"
        cp -r "$folder/32" "$folder/damaged"
        sed "$1" "$folder/32/history.dat" > "$folder/damaged/history.dat"
        PLOTS=$folder/plots sh common/plot.sh "$folder/damaged" > "$folder/told" 2>&1
    }
    for edit in d 1d '5s/ [^ ]*$//' '7s/.*/lost and found/'; do
        damage "$edit"
        [ $? = 2 ] && [ "$(grep -c 'make the run again' "$folder/told")$(wc -l < "$folder/told")" = 11 ] || complain "history.dat after sed '$edit': $(cat "$folder/told")"
    done
    damage '$s/ [^ ]*$//' || complain "a last line that is not whole: $(cat "$folder/told")"
    # Pictures of a run that has not come to its end say so, and how far it has come.
    for ending in '' 3 130; do
        if [ "$ending" ]; then sed "s/\"status\": 0/\"status\": $ending/" "$folder/32/summary.json" > "$folder/damaged/summary.json"; else rm "$folder/damaged/summary.json"; fi
        said=$(sh common/plot.sh "$folder/damaged" 2>&1 | sed -n 's/^note: .*damaged, \(.*\) at t = 0.[12][0-9]* of 0.2[.].*/\1/p')
        [ "$ending $said" = " not ended" ] || [ "$ending $said" = "3 failed" ] || [ "$ending $said" = "130 stopped" ] || complain "of a run with status '$ending' plot.sh says '$said'"
    done
    # A run that goes on is not called by its earlier end, and one that was killed is not watched for ever.
    flock "$folder/damaged/.lock" sh common/plot.sh "$folder/damaged" 2>&1 | grep -q '^note: .*, not ended at t' || complain "a run that goes on is said to have ended"
    rm -f "$folder/damaged/summary.json"
    PLOTS=$folder/plots timeout 60 sh common/plot.sh watch "$folder/damaged" > "$folder/told" 2>&1 || complain "a run that was killed is watched: $(cat "$folder/told")"
    rm -rf out/figures/flip--*--damaged
    # Folders whose names differ have pictures that differ; a name that gnuplot cannot read is refused.
    mkdir -p "$folder/a/b"
    for run in "$folder/a/b" "$folder/a_b" "$folder/a b" "$folder/a\\b"; do
        cp -r "$folder/32/." "$run"
        sh common/plot.sh "$run" 2>&1 | sed -n 's/^figure: \(.*\)\/history.png/\1/p; s/^gnuplot cannot read .* backslash .*/refused/p'
    done > "$folder/told"
    [ "$(sort -u "$folder/told" | grep -c .)" = 4 ] || complain "pictures of four runs lie in $(cat "$folder/told")"
    rm -rf out/figures/flip--*--a--b out/figures/flip--*--a_b out/figures/flip--*"--a b"
    for script in history results; do
        gnuplot -e "run='$folder/32'; out='$folder/$script.svg'; ended=', stopped at t = 0.1 of 0.2'" common/figures/$script.gp
        grep -q 'stopped at t = 0.1 of 0.2<' "$folder/$script.svg" || complain "$script.gp does not say that the run was stopped"
    done

    # Lines of a field have places where the axes show no numbers.
    for x in 0 1 2; do for z in 0 1 2; do echo "$x $z $((x + z))"; done; echo; done > "$folder/plane"
    gnuplot -e "out='$folder/plane.svg'" -e "load 'common/style.gp'; set format ''; eval contours_of('$folder/plane', '1:2:3', 'levels discrete 1.5', '\$lines'); set print '-'; print \$lines" |
        awk 'NF > 1 && $1 + $2 == 1.5 { ++there } END { exit there < 3 }' || complain "contours over axes without numbers have no places"

    # A sweep is the product of its lists, its table has every run, and the second time nothing is run.
    # Paths may have blanks and quotes.
    place="$folder/it's a sweep" case="$folder/Sod's case.toml"
    cp flip/cases/sod.toml "$case"
    sweep() { PROGRAM=flip BUILD=$build SWEEP=$place sh common/sweep.sh "$case" "$@" > "$folder/told" 2>&1; }
    SWEEP_ONLY=2/3 sweep cells_x=20,30 flip.transfer=flip,apic,pic -- time.end=0.05
    [ "$(grep -c . "$place/results.dat")" = 3 ] || complain "an element of two runs of six has $(grep -c . "$place/results.dat") lines"
    sweep cells_x=20,30 flip.transfer=flip,apic,pic -- time.end=0.05 || complain "sweep: $(cat "$folder/told")"
    [ "$(awk 'NR > 1 { print $1, $2 }' "$place/results.dat" | sort -u | grep -c .)" = 6 ] || complain "the table does not have six runs"
    [ "$(awk 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "L1_density") c = i } NR > 1 && $c > 0 && $c < 1' "$place/results.dat" | grep -c .)" = 6 ] || complain "the table lacks results"
    # shellcheck disable=SC2012
    before=$(ls -l --time-style=full-iso "$place"/*/summary.json)
    sweep cells_x=20,30 flip.transfer=flip,apic,pic -- time.end=0.05
    # shellcheck disable=SC2012
    [ "$before" = "$(ls -l --time-style=full-iso "$place"/*/summary.json)" ] || complain "a complete sweep was run again"
    # Another call adds to the table; the figure counts verdicts.
    sweep cells_x=24 flip.transfer=flip -- time.end=0.05 || complain "sweep: $(cat "$folder/told")"
    [ "$(sed -n '2,$s/^\([0-9]*\) \([a-z]*\) .*/\1\2/p' "$place/results.dat" | sort | tr '\n' ' ')" = '20apic 20flip 20pic 24flip 30apic 30flip 30pic ' ] || complain "the table lacks the runs of an earlier call"
    awk -f common/figures/sweep.awk "$place/results.dat" | grep -q "energy.*, 7 of 7 PASS'" || complain "the figure of a sweep shows no verdicts"
    rm -f "out/figures/sweep_it's a sweep.png"
    sweep cells_x=20,0 && complain "a run that failed was not told"
    # What cannot be swept is refused with its name.
    refuses() { sweep "$1"; [ $? = 2 ] && [ "$(cat "$folder/told")" = "$2" ] || complain "sweep $1: $(cat "$folder/told")"; }
    for list in cells_x= cells_x=,20 cells_x=20, cells_x=20,,30; do refuses "$list" "'$list' lacks a value: KEY=VALUE,VALUE"; done
    refuses --threads=2 "'--threads=2' is not KEY=VALUE,VALUE; what is the same for all runs follows --"
    sweep cells_x=20 -- --threads 2
    [ $? = 2 ] && grep -q "^'--threads' cannot follow --" "$folder/told" || complain "sweep -- --threads 2: $(cat "$folder/told")"
    refuses sead=1 "'sead' is no parameter of $build/flip"
    said=$(sh common/sweep.sh nix.toml seed=1 2>&1)
    [ "$said" = "no such case: nix.toml" ] || complain "sweep of a missing case: $said"
    ;;
esac
exit $status
