# lab.sh: what the experiments share. Each is started as  sh EXPERIMENT.sh PROGRAM FOLDER SECONDS  in
# the root of the project; its last line is "tried failed", and FOLDER/failures says what failed.
export LC_ALL=C.UTF-8 GOMP_SPINCOUNT=2000  # a program starts itself again where this is not said
: "${BUILD:=build}" "${MAKE:=make}"
program=$1 folder=$2 seconds=${3:-60} tried=0 failed=0
rm -rf "$folder"
mkdir -p "$folder"
ulimit -c 0

case $program in  # a run of a tenth of a second with five checkpoints or more
cic) words='cic/cases/sheath.toml time.dt=0.4 grid.cells_x=48 grid.length_x=12 time.end=8' every=5 ;;
pic) words='flip/cases/sod.toml grid.cells_x=40 time.end=0.1' every=5 ;;
flip) words='flip/cases/rotating_disk.toml grid.cells_x=20 grid.cells_z=20 time.dt=0.03 time.end=1 gravity.x=0.6' every=5 ;;
mpm_explicit) words='mpm_explicit/cases/rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12 grain.left.x=0.39 grain.right.x=0.81 time.end=0.3' every=10 ;;
mpm_implicit) words='mpm_implicit/cases/rebound.toml theory.compare=none grid.cells_x=24 grid.cells_y=12 grain.left.x=0.39 grain.left.y=0.35 grain.right.x=0.81 time.end=0.3' every=4 ;;
implicit_moment) words='implicit_moment/cases/gem.toml harris.particles=4000 grid.cells_x=16 grid.cells_z=16 time.end=6' every=4 ;;
explicit_em) words='implicit_moment/cases/gem_explicit.toml harris.particles=6000 grid.cells_x=32 grid.cells_z=16 time.dt=0.2 time.end=4 output.history_steps=1' every=4 ;;
esac
run="$BUILD/$program $words output.checkpoint_steps=$every --quiet --threads 1 --resume --out"

fell() { failed=$((failed + 1)); echo "$program: $*" >> "$folder/failures"; }
say() { echo "$tried $failed"; }
whole() { $run "$folder/whole" > /dev/null 2>&1; }  # the run that nobody disturbs
# in_contract STATUS: is it one that the README names? 137 only where somebody killed.
in_contract() { case $1 in 0 | 2 | 3 | 130 | 143) ;; *) false ;; esac; }

# nothing_half FOLDER WHAT: no file is there in part.
nothing_half() {
    half=$(find "$1" -name '*.partial' -o -name summary.json -empty)
    [ -z "$half" ] || fell "$2: left in part: $half"
}

# goes_on FOLDER WHAT: --resume ends with the bytes of the undisturbed run.
goes_on() {
    timeout 60 $run "$1" > "$folder/said" 2>&1
    status=$?
    [ $status = 0 ] || { fell "$2: --resume ends with $status: $(tail -1 "$folder/said")"; return; }
    for file in "$folder"/whole/*; do
        case $file in */summary.json) continue ;; esac
        cmp -s "$file" "$1/${file##*/}" || { fell "$2: ${file##*/} has other bytes"; return; }
    done
    nothing_half "$1" "$2, resumed"
}
