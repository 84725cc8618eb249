#!/bin/sh
# movie.sh RUN [KIND]: an animation of the snapshots of a run, of fields, particles, phase space or fringes, whichever it has, or of one KIND: mp4 and webp with ffmpeg, else gif.
# The colors and ranges are those of all frames. QUANTITIES='J_y': only these fields; FRAMES: at most so many, evenly chosen (120); RATE: frames per second (12); PLOTS: the folder.
set -eu
export LC_ALL=C.UTF-8
run=$1
kinds=${2:-particles fields phase fringes}
plots=${PLOTS:-out/figures}
frames=$(mktemp -d)
trap 'rm -rf "$frames"' EXIT
trap 'exit 1' HUP INT TERM
mkdir -p "$plots"
made=

for kind in $kinds; do
    times=$(sh common/snapshots.sh some "$run" "$kind" "${FRAMES:-120}")
    [ "$(echo "$times" | wc -w)" -gt 1 ] || continue
    set --
    for time in $times; do set -- "$@" "$(sh common/snapshots.sh file "$run" "$kind" "$time")"; done
    FRAME_FOLDER=$frames sh common/figures/snapshots.sh "$run" "$kind" "$@" > "$frames/page.gp"
    gnuplot -e "heading='$run'; ended='${ENDED:-}'" "$frames/page.gp"
    name=$plots/$kind
    if command -v ffmpeg >/dev/null; then
        movie() { ffmpeg -loglevel error -y -framerate "${RATE:-12}" -start_number 1 -i "$frames/%06d.png" "$@"; }
        movie -vf 'pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white' -c:v libx264 -pix_fmt yuv420p -crf 20 "$frames/movie.mp4"
        movie -vf "scale='min(760,iw)':-2" -c:v libwebp_anim -loop 0 -quality 55 "$frames/movie.webp"
        endings='mp4 webp'
    else
        echo "note: without ffmpeg (make deps-sweep) it becomes a gif" >&2
        gnuplot 2>/dev/null <<EOD
set terminal gif animate delay $((100 / ${RATE:-12})) size 1000, 700
set output '$frames/movie.gif'
unset border; unset tics; unset key; set margins 0, 0, 0, 0; set size ratio -1
do for [picture in system('ls $frames/*.png')] { plot picture binary filetype=png with rgbimage }
EOD
        endings=gif
    fi
    rm -f "$frames"/*.png
    for ending in $endings; do
        mv "$frames/movie.$ending" "$name.$ending"
        made="$made $name.$ending"
    done
done
[ -n "$made" ] || { echo "$run has no two snapshots of $kinds: set output.particles_interval or output.fields_interval" >&2; exit 2; }
for file in $made; do echo "animation: $file ($(($(wc -c < "$file") / 1000)) kB)"; done
