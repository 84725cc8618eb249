#!/bin/sh
# ranks.sh BUILD FACT [PROGRAM]: facts about the programs of `make MPI=1 all`, beside those of `make all`: bytes, restart, memory and stop of each
# program, and refuse. Status 77, for "not tested", where there are none. Ranks share the cores of this machine.
set -u
export LC_ALL=C.UTF-8
one=$1 many=$1/mpi
command -v mpirun > /dev/null || { echo "there is no mpirun (make deps-mpi): not tested"; exit 77; }
for program in explicit_em implicit_moment cic; do [ -x "$many/$program" ] || { echo "there is no build/mpi/$program (make MPI=1 all): not tested"; exit 77; }; done
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM
status=0
complain() { echo "$*" >&2; status=1; }

# A sheet that reconnects; a beam through the periodic ends of a mesh of four strips, of which the last has one row, .93 cells per step; a plasma
# thrown at a wall, which leaves rows empty behind it.
short_sheet="implicit_moment/cases/gem_explicit.toml grid.cells_x=32 grid.cells_z=32 time.dt=0.2 harris.particles=5e4 output.history_steps=2"
records='output.history_steps=2 output.checkpoint_steps=30'
sheet="explicit_em $short_sheet time.end=12 output.checkpoint_steps=30 output.fields_interval=6 output.particles_interval=6"
neutral='[plasma]\nsetup = "uniform"\nloading = "random"\n[uniform]\nparticles_per_cell = %s\n[species.ions]\ncharge = 1\nmass = 1\ndrift_z = %s\ntemperature_x = 1e-3
    \ntemperature_z = 1e-3\n[species.electrons]\ncharge = -1\nmass = 0.5\ndrift_z = %s\n[grid]\ncells_x = 8\ncells_z = %s\nlength_x = 8\nlength_z = %s\nboundary_z = "%s"
    \n[time]\ndt = %s\nend = %s\n[particles]\norder = %s\n[theory]\nwave = "none"\n'
# shellcheck disable=SC2059
{
    printf "$neutral" 20 5 5 12 1.2 periodic 0.095 5.7 2 > "$scratch/beam.toml"
    printf "$neutral" 40 0.6 0.6 32 3.2 wall 0.08 4.8 1 > "$scratch/crowd.toml"
}
beam="explicit_em $scratch/beam.toml field.smoothing_passes=2 $records"
crowd="explicit_em $scratch/crowd.toml $records"
# The same of implicit_moment, each way of it: a beam of gamma v = 5 c in a magnetic field that goes around half of the mesh in a step; the crowd.
short_gem="implicit_moment/cases/gem.toml grid.cells_x=24 grid.cells_z=24 harris.particles=6e3"
records='output.checkpoint_steps=30 output.fields_interval=6 output.particles_interval=6'
moments="implicit_moment $short_gem time.end=18 $records"
mass="$moments field.response=mass_matrix"
newton="implicit_moment $short_gem time.end=3 field.solver=newton_krylov field.rotation=mesh harris.guide_field=0.3 $records"
paths="implicit_moment $short_gem time.end=1.5 field.solver=newton_krylov field.response=mass_matrix $records"
tail="implicit_moment implicit_moment/cases/magnetotail.toml grid.cells_x=24 grid.cells_z=24 harris.particles=6e3 time.end=6"
sed 's/order = .*/relativistic = true/' "$scratch/beam.toml" > "$scratch/sweep.toml"
sed '/order = /d' "$scratch/crowd.toml" > "$scratch/wall.toml"
sweep="implicit_moment $scratch/sweep.toml uniform.B_x=2 time.dt=0.6 time.end=36 uniform.particles_per_cell=6 $records"
sweep_mass="$sweep field.response=mass_matrix"
wall="implicit_moment $scratch/wall.toml uniform.particles_per_cell=10 time.end=2.4 $records"

# Of cic: two streams in the plane, warm and loaded in no order, which cross the mesh along z in four steps and are sorted often; the same in one dimension; a
# source and an absorbing wall in a magnetic field, the ions crossing the mesh along them; a plasma in a box that leaves it through one wall, to the last ion.
files='output.fields_interval=3 output.particles_interval=3 output.phase_interval=3 output.checkpoint_steps=30'
for s in right left; do warm="${warm-} species.$s.loading=random species.$s.temperature_x=0.1 species.$s.temperature_z=0.1 species.$s.particles_per_cell=10"; done
streams="cic/cases/two_stream_2d.toml grid.cells_x=16 grid.cells_z=16$warm species.right.drift_z=26 species.left.drift_z=-25 method.sort_interval=4 theory.compare=none"
plane="cic $streams time.end=6 $files"
line="cic cic/cases/two_stream.toml time.dt=0.1 time.end=6 $files"
between='[grid]\ndimensions = 2\ncells_x = 16\ncells_z = 16\nlength_x = 16\nlength_z = 16\nboundary_x = "wall"\n%b[time]\ndt = 0.1\nend = 6\n[method]\nsort_interval = 4
    \n[plasma]\nB_y = %b\n[species.electrons]\n%b\n[species.ions]\ncharge = 1\nmass = 4\n%b\n[theory]\ncompare = "none"\n'
warm='loading = "random"\ntemperature_x = 1\ntemperature_y = 1\ntemperature_z = 1\nparticles_per_cell = 9\nemission = 3'
disk='profile = "disk"\ncenter_x = 6\ncenter_z = 9\nhalf_width = 4\nparticles_per_cell = 20'
# shellcheck disable=SC2059
{
    printf "$between" '[boundary]\nx_low = "floating"\nparticles_x_low = "source"\nx_high = "floating"\n' 0.5 "$warm" "$warm\ndrift_z = 24" > "$scratch/source.toml"
    printf "$between" 'boundary_z = "wall"\n[boundary]\nparticles_x_low = "reflect"\nparticles_z_low = "reflect"\n' 0 "$disk\ndrift_x = 3.5\ndrift_z = 9\ntemperature_x = 0.1" \
        "$disk\ndrift_x = 5" > "$scratch/box.toml"
}
source="cic $scratch/source.toml $files"
box="cic $scratch/box.toml $files"

# same A B: the files of two runs, and their results; what a summary says of ranks and times is theirs.
same() {
    for file in "$1"/*; do
        file=${file##*/}
        [ "$file" = summary.json ] || cmp -s "$1/$file" "$2/$file" || complain "$2: another $file"
    done
    for run in "$1" "$2"; do sed -n '/"results"/,/"performance"/p' "$run/summary.json" > "$run.results"; done
    cmp -s "$1.results" "$2.results" || complain "$2: other results"
}
performance() { sed -n "s/.*\"$2\": *\([-+.0-9e]*\).*/\1/p" "$1/summary.json"; }
# start N OUT ...: N ranks, 0: the program without ranks
start() {
    n=$1 out=$2 said=$2.said; shift 2
    if [ "$n" = 0 ]; then set -- "$one/$program" "$@"; else set -- timeout "${PATIENCE:-120}" mpirun -n "$n" "$many/$program" "$@"; fi
    "$@" --quiet --out "$out" 2> "$said"
}

program=${3:-explicit_em}
case $program.$2 in
explicit_em.bytes) names='sheet beam crowd' ;;
explicit_em.restart) names='sheet beam' ;;
cic.bytes) names='plane line source box' ;;
cic.restart) names='plane source' ;;
implicit_moment.bytes) names='moments mass newton paths tail sweep sweep_mass wall' ;;
implicit_moment.restart) names='moments mass sweep' ;;
explicit_em.stop) long="$short_sheet" ;;
cic.stop) long="$streams output.particles_interval=0 time.energy_limit=0" ;;
implicit_moment.stop) long="$short_gem" ;;
esac

case $2 in
bytes)
    for name in $names; do
        eval "set -- \$$name"
        shift
        start 0 "$scratch/$name" "$@" --threads 1 || complain "$name: $(cat "$said")"
        for n in 1 2 3 4; do
            for threads in 1 2; do
                start $n "$scratch/$name.$n.$threads" "$@" --threads $threads || complain "$out: $(cat "$said")"
                same "$scratch/$name" "$out"
                [ "$(performance "$out" ranks)" = $n.0 ] || complain "$out: it had '$(performance "$out" ranks)' ranks"
            done
        done
    done
    # Borders have moved: with those of the start one of two ranks would have three quarters of the crowd.
    [ $program != explicit_em ] || awk "BEGIN { exit !($(performance "$scratch/crowd.2.1" imbalance) <= 1.2) }" || complain "most of the crowd is with one rank"
    ;;
restart)
    for name in $names; do
        eval "set -- \$$name"
        shift
        start 0 "$scratch/$name" "$@" --threads 1
        for pair in '4 0' '4 1' '0 3' '2 4' '3 2'; do
            start "${pair% *}" "$scratch/$name.${pair% *}${pair#* }" "$@" --threads 1
            rm "$out/checkpoint_0000000060.bin" "$out/summary.json"
            start "${pair#* }" "$out" --restart "$out/checkpoint_0000000030.bin" --threads 1 || complain "$pair: $(cat "$said")"
            same "$scratch/$name" "$out"
        done
    done
    ;;
refuse)
    # refused N STATUS SENTENCE ...: ends with the status, and with the sentence once
    refused() {
        n=$1 wanted=$2 sentence=$3; shift 3
        begin=$(date +%s)
        start "$n" "$scratch/refused" "$@"
        found=$?
        [ $found = "$wanted" ] || complain "$sentence: status $found"
        [ "$(grep -c "$sentence" "$said")" = 1 ] || complain "not once '$sentence': $(cat "$said")"
        [ $(($(date +%s) - begin)) -le 10 ] || complain "$sentence: after $(($(date +%s) - begin)) s"
    }
    # shellcheck disable=SC2086
    set -- $box
    program=$1; shift
    refused 17 2 '17 ranks, and the particles are in 16 blocks' "$@"
    # shellcheck disable=SC2086
    set -- $beam
    program=$1; shift
    refused 5 2 '5 ranks, and the mesh has 4 strips of 4 rows' "$@"
    refused 4 2 "unknown parameter 'grid.cells_w'" "$@" grid.cells_w=3
    refused 2 2 'leave out mpirun' "$@" --refine 2
    program=implicit_moment
    # shellcheck disable=SC2086
    refused 7 2 '7 ranks, and the mesh has 13 rows of nodes' ${sweep#* }
    program=explicit_em
    # shellcheck disable=SC2086
    timeout 120 mpirun -n 1 "$many/cic" ${line#* } --quiet --out "$scratch/refused" : -n 1 "$many/cic" ${line#* } theory.compare=none --quiet \
        --out "$scratch/refused" 2> "$said"
    [ $? = 2 ] && grep -q 'ranks have read different cases' "$said" || complain "ranks with different cases: $(cat "$said")"
    [ -e "$scratch/refused" ] && complain "a refused case has left a folder"
    start 4 "$scratch/refused" "$@" --dry-run > "$scratch/words"
    [ -e "$scratch/refused" ] && complain "a dry run has left a folder"
    timeout 120 mpirun -n 3 "$many/$program" --version > "$scratch/words"
    [ "$(wc -l < "$scratch/words")" = 1 ] || complain "the version: $(cat "$scratch/words")"
    # All fail alike, each having met some of what is counted.
    blown_up="particles.relativistic=false species.ions.drift_z=0.5 species.electrons.drift_z=0.5 uniform.wave_E_z=1e3 uniform.mode_x=1"
    # shellcheck disable=SC2086
    start 0 "$scratch/alone" "$@" $blown_up
    # shellcheck disable=SC2086
    refused 3 3 "$(grep 'cross more than a cell' "$said")" "$@" $blown_up
    blown_up="${sweep_mass#* } --force"
    program=implicit_moment
    # shellcheck disable=SC2086
    start 0 "$scratch/alone" $(echo "$blown_up" | sed 's/dt=0.6/dt=1e4/; s/end=36/end=1e4/')
    # shellcheck disable=SC2046
    refused 3 3 "$(grep 'cross more than 1000 boxes' "$said")" $(echo "$blown_up" | sed 's/dt=0.6/dt=1e4/; s/end=36/end=1e4/')
    program=explicit_em
    refused 2 2 'holds an earlier run' "$@"
    # One fails alone: for want of memory, and where the folder is taken away from the first.
    cat > "$scratch/poor" <<- end
	#!/bin/sh
	[ "\${OMPI_COMM_WORLD_RANK:-\$PMI_RANK}" = 1 ] && ulimit -v 300000
	exec "$(realpath "$many/$program")" "\$@"
	end
    chmod +x "$scratch/poor"
    mpi=$many many=$scratch program=poor
    refused 3 2 'memory, and there is' implicit_moment/cases/gem_explicit.toml harris.particles=3e7 --force
    many=$mpi program=explicit_em
    # One fails later, when no more memory is to be had: it leaves the summary that the first cannot write. With MPICH the
    # library may be the first that wants memory, and ends the run without a word.
    if ! mpirun --version 2>&1 | grep -qi hydra; then
        MALLOC_MMAP_THRESHOLD_=4096
        export MALLOC_MMAP_THRESHOLD_
        (
            for _ in $(seq 100); do ls "$scratch"/refused/checkpoint_* > /dev/null 2>&1 && break; sleep 0.1; done
            prlimit --as=1000000 --pid "$(pgrep -f "^$many/$program.*$scratch/refused" | sed -n 2p)"
        ) &
        # shellcheck disable=SC2086
        refused 3 2 'not enough memory for this case' $short_sheet --force time.end=1e6 output.checkpoint_steps=20
        grep -q '"message": "not enough memory' "$scratch/refused/summary.json" || complain "no summary of the one that failed alone"
    fi
    unset MALLOC_MMAP_THRESHOLD_
    (sleep 4; mv "$scratch/refused" "$scratch/gone") &
    refused 3 2 'cannot be opened for writing' "$@" --force time.end=1e6
    # The same of cic: the one rank that meets a leap, not the first, tells the others, and the summary says so.
    program=cic leap='species.electrons.loading=random species.electrons.temperature_z=2e4 boundary.particles_z_high=reflect plasma.seed=8'
    # shellcheck disable=SC2086
    start 0 "$scratch/leap" ${box#* } $leap
    # shellcheck disable=SC2086
    refused 3 3 "$(grep 'farther than the box' "$said")" ${box#* } --force $leap
    grep -q '"status": 3' "$scratch/refused/summary.json" || complain "no summary of a leap"
    (sleep 4; mv "$scratch/refused" "$scratch/gone.cic") &
    # shellcheck disable=SC2086
    refused 3 2 'cannot be .*No such file' $streams --force output.fields_interval=1 time.end=1e6
    ;;
memory)
    # What a rank has of memory beyond what it has without particles is its share of them, at the start and when it restarts: of four, less than half of
    # all, because for a moment a list is there twice.
    # rise N OUT ...: the most of one of N ranks
    rise() {
        start "$@" || complain "$out: $(cat "$said")"
        bytes=$(performance "$out" peak_memory_bytes)
        bytes=$((${bytes%.*} - least))
    }
    case $program in
    explicit_em) few=harris.particles=5e3 many_more=harris.particles=2e6 thin="${short_sheet% harris.*} time.end=0.8" ;;
    implicit_moment) few=harris.particles=5e3 many_more=harris.particles=2e6 thin="implicit_moment/cases/gem.toml grid.cells_x=16 time.end=1.2" ;;
    cic) few=species.right.particles_per_cell=9 many_more=species.right.particles_per_cell=10000 thin="cic/cases/two_stream_2d.toml grid.cells_x=16 grid.cells_z=16 time.end=0.4 theory.compare=none output.particles_interval=0" ;;
    esac
    thin="$thin output.checkpoint_steps=2 output.fields_interval=0 --threads 1"
    begun='' restarted=''
    for n in 1 4; do
        least=0
        # shellcheck disable=SC2086
        rise $n "$scratch/few$n" $thin $few
        least=$bytes
        # shellcheck disable=SC2086
        rise $n "$scratch/memory$n" $thin $many_more
        begun="$begun $bytes"
        rise $n "$scratch/memory$n" --restart "$scratch/memory$n/checkpoint_0000000002.bin" --threads 1
        restarted="$restarted $bytes"
    done
    echo "$begun $restarted" | awk '{ exit !(NF == 4 && $1 > 5e7 && $2 <= 0.5 * $1 && $3 > 5e7 && $4 <= 0.5 * $3) }' ||
        complain "bytes of one rank and of one of four, begun$begun and restarted$restarted"
    ;;
stop)
    # begin N: N ranks in the background; they have taken some steps
    begin() {
        out=$scratch/stopped
        mpirun -n "$1" "$many/$program" $long --quiet --out "$out" --resume > "$scratch/words" 2>&1 &
        mpirun=$!
        for _ in $(seq 100); do ls "$out"/checkpoint_* > /dev/null 2>&1 && pgrep -f "^$many/$program.*$out" > /dev/null && break; sleep 0.1; done
        sleep "0.$(($(od -An -N1 -tu1 /dev/urandom) % 10))"
    }
    # ended STATUS: how mpirun has ended, and that within ten seconds and with nothing left; the last checkpoint is whole
    ended() {
        before=$(date +%s)
        wait $mpirun
        found=$?
        [ $(($(date +%s) - before)) -le 10 ] || complain "$1: after $(($(date +%s) - before)) s"
        case " $1 " in *" $found "*) ;; *) complain "status $found, not one of $1: $(cat "$scratch/words")" ;; esac
        sleep 0.2
        pgrep -f "^$many/$program.*$out" && complain "$1: some still run"
        last=$(ls "$out"/checkpoint_*.bin | tail -n 1)
        "$one/$program" --verify "$last" > /dev/null || complain "$1: $last is not whole"
    }
    # What mpirun says when it is told to stop, and when a rank is killed: Open MPI and MPICH have statuses of their own.
    told='1 130 143' killed=137
    if mpirun --version 2>&1 | grep -qi hydra; then told='0 2 130 143' killed='9 137'; fi
    # Two seconds for each signal, as fast as this machine is now.
    long="$long output.checkpoint_steps=20 output.fields_interval=0 --threads 1"
    since=$(date +%s%N)
    # shellcheck disable=SC2086
    start 2 "$scratch/probe" $long time.end=200
    milliseconds=$((($(date +%s%N) - since) / 1000000))
    long="$long time.end=$((200 * 2000 * (${KILLS:-3} + 3) / milliseconds))"
    # shellcheck disable=SC2086
    start 0 "$scratch/whole" $long
    # A signal to mpirun; one to a rank; and the worst one.
    for signal in TERM INT; do
        begin 2
        kill -$signal $mpirun
        ended "$told"
        grep -q '"status": 1[34]' "$out/summary.json" || complain "$signal: $(grep status "$out/summary.json")"
    done
    begin 3
    kill -INT "$(pgrep -f "^$many/$program.*$out" | sed -n 2p)"
    ended 130
    for _ in $(seq "${KILLS:-3}"); do
        begin 3
        kill -KILL "$(pgrep -f "^$many/$program.*$out" | shuf -n 1)"
        ended "$killed"
    done
    # shellcheck disable=SC2086
    start 4 "$out" $long --resume || complain "resumed: $(cat "$said")"
    same "$scratch/whole" "$out"
    ;;
*) complain "no such fact: $2" ;;
esac
exit $status
