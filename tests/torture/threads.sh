# threads.sh: two threads under the thread sanitizer; archer tells it what OpenMP waits for. Its
# positive control, a planted race, must be found.
. tests/torture/lab.sh
made thread thread '' "all $BUILD/torture/thread/planted_race"
BUILD=$BUILD/torture/thread
case $program in  # more numbers than a loop needs to be shared by threads
cic) words='cic/cases/two_stream_2d.toml time.end=1 theory.compare=none' ;;
pic | flip) words='flip/cases/rayleigh_taylor.toml time.end=0.02' ;;
mpm_explicit) words='mpm_explicit/cases/compressed.toml time.end=0.05 theory.compare=none' ;;
mpm_implicit) words='mpm_implicit/cases/compressed.toml time.end=0.1 theory.compare=none' ;;
implicit_moment) words='implicit_moment/cases/gem.toml harris.particles=20000 time.end=4' ;;
explicit_em) words='implicit_moment/cases/gem_explicit.toml harris.particles=40000 time.end=1' ;;
esac
fixed=  # addresses that are not drawn by lot, where that may be asked for
setarch -R true 2> /dev/null && fixed='setarch -R'
watched() {
    OMP_NUM_THREADS=2 KMP_BLOCKTIME=0 OMP_TOOL_LIBRARIES=$(clang++ -print-file-name=libarcher.so) \
        TSAN_OPTIONS='ignore_noninstrumented_modules=1 exitcode=66' \
        $fixed timeout 300 "$@" > "$folder/said" 2>&1
}
tried=2
watched "$BUILD/$program" $words output.checkpoint_steps=5 --quiet --out "$folder/run"
status=$?
[ $status = 0 ] || fell "status $status under the thread sanitizer, see $folder/said"
mv "$folder/said" "$folder/said_by_program"
watched "$BUILD/planted_race"
[ $? = 66 ] || fell "the planted race is not found"
say
