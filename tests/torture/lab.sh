# lab.sh: what the experiments share. Each is started in the root of the project as
#   sh tests/torture/EXPERIMENT.sh PROGRAM FOLDER SECONDS
# Its last line is "tried failed", and FOLDER/failures says what failed.
export LC_ALL=C.UTF-8 GOMP_SPINCOUNT=2000  # a program starts itself again where this is not said
: "${BUILD:=build}" "${MAKE:=make}"
program=$1 folder=$2 seconds=${3:-60} tried=0 failed=0
rm -rf "$folder"
mkdir -p "$folder"
ulimit -c 0

every=5  # steps from one checkpoint to the next
[ "$program" = mpm_explicit ] && every=10
case $program in  # a run of a tenth of a second with four checkpoints or more
cic) words='cic/cases/sheath.toml time.dt=0.4 grid.cells_x=48 grid.length_x=12 time.end=8' ;;
pic) words='flip/cases/sod.toml grid.cells_x=40 time.end=0.1' ;;
flip)
    words='flip/cases/rotating_disk.toml grid.cells_x=20 grid.cells_z=20 time.dt=0.03 time.end=1'
    words="$words gravity.x=0.6" ;;
mpm_*)
    words="$program/cases/rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12"
    words="$words grain.left.x=0.39 grain.left.y=0.35 grain.right.x=0.81 time.end=0.3" ;;
implicit_moment)
    words='implicit_moment/cases/gem.toml harris.particles=4000 grid.cells_x=16 grid.cells_z=16'
    words="$words time.end=6" ;;
explicit_em)
    words='implicit_moment/cases/gem_explicit.toml harris.particles=6000 grid.cells_x=32'
    words="$words grid.cells_z=16 time.dt=0.2 time.end=4 output.history_steps=1" ;;
esac
run="$BUILD/$program $words output.checkpoint_steps=$every --quiet --threads 1 --resume --out"

fell() { failed=$((failed + 1)); echo "$program: $*" >> "$folder/failures"; }
say() { echo "$tried $failed"; }
# made KIND SANITIZERS FLAGS TARGETS: built with clang in a folder of its own, by one at a time.
made() {
    mkdir -p "$BUILD/torture"
    flock "$BUILD/torture/lock" $MAKE -s BUILD="$BUILD/torture/$1" CXX=clang++ SANITIZE="$2" \
        OPTIMIZE="-O1 -gline-tables-only${3:+ $3}" $4 > "$folder/built" 2>&1 ||
        fell "is not built: $(tail -1 "$folder/built")"
}
whole() { $run "$folder/whole" > /dev/null 2>&1; }  # the run that nobody disturbs
# in_contract STATUS: is it one that the notes name? 137 only where somebody killed.
in_contract() { case $1 in 0 | 2 | 3 | 129 | 130 | 143) ;; *) false ;; esac; }

# nothing_half FOLDER WHAT: no file is there in part.
nothing_half() {
    half=$(find "$1" -name '*.partial' -o -name summary.json -empty)
    [ -z "$half" ] || fell "$2: left in part: $half"
}

# goes_on FOLDER WHAT: --resume ends with the bytes of the undisturbed run.
goes_on() {
    timeout 60 $run "$1" > "$folder/said" 2>&1
    status=$?
    if [ $status != 0 ]; then
        fell "$2: --resume ends with $status: $(tail -1 "$folder/said")"
        return
    fi
    newest=$(ls "$folder"/whole/checkpoint_* | tail -n 1)
    for file in "$folder"/whole/*; do
        case $file in
        */summary.json) continue ;;
        # Two are kept: that of a signal may stand in the place of the last but one.
        */checkpoint_*) [ ! -f "$1/${file##*/}" ] && [ "$file" != "$newest" ] && continue ;;
        esac
        cmp -s "$file" "$1/${file##*/}" || { fell "$2: ${file##*/} has other bytes"; return; }
    done
    nothing_half "$1" "$2, resumed"
}
