#!/bin/sh
# plot.sh [draw] RUN        draw every figure that fits a run, e.g.  sh common/plot.sh out/cic/mine
# plot.sh list RUN          name their scripts only
# plot.sh watch RUN         draw its history and its last snapshots every few seconds (EVERY=5) until it ends; TEXT=1: its energies as text, for a terminal
# plot.sh compare A B       the histories and the results of two runs on one page
# plot.sh movie RUN         an animation of its snapshots, mp4 and webp with ffmpeg, else gif
# Pictures go to out/figures/PROGRAM_NAME/ of out/PROGRAM/NAME, to out/figures/PROGRAM--a--b/ of any other folder a/b, or to the folder PLOTS. A script of figures says itself which runs it fits, in a line
#   # fits: PROGRAM|PROGRAM SECTION.KEY=VALUE|VALUE SECTION.KEY!=VALUE result:NAME file:PATTERN kinds:KIND,KIND
# whose conditions must all hold: a parameter of the run's case.toml, a result of its summary.json, files in its folder. With kinds the script is run for each
# kind of snapshots that there is, as the variable `kind`. `any` is every program.
set -eu
export LC_ALL=C.UTF-8
trap 'rm -f "${partial:-}"' EXIT
trap 'exit 130' HUP INT TERM

fail() { printf '%s\n' "$*" >&2; exit 2; }

case ${1:-} in
list | draw | watch | compare | movie) mode=$1; shift ;;
*) mode=draw ;;
esac
[ -n "${1:-}" ] || fail "which run? RUN=out/cic/mine is its folder (with compare: A= and B=)"

# Folders are named from where the command was given; scripts are read from the project's root.
absolute() { (cd "$1" 2>/dev/null && pwd) || fail "there is no folder $1"; }
run=$(absolute "$1")
other=${2:+$(absolute "$2")}
cd "$(dirname "$0")/.."
here=$(pwd)
run=${run#"$here"/} other=${other#"$here"/}
for folder in "$run" ${other:+"$other"}; do
    [ -f "$folder/case.toml" ] && [ -f "$folder/history.dat" ] || fail "$folder is not the folder of a run: it needs case.toml and history.dat"
    # The last line may be in the making.
    damage=$(awk 'NR == 1 { columns = NF; if ($1 != "time") { print "does not begin with the names of its columns"; exit } next }
        /^#/ { next }
        bad { print "is damaged: line " bad " is not " columns " numbers"; exit }
        NF != columns { bad = NR }
        { for (i = 1; i <= NF; i++) if ($i + 0 != $i) bad = NR }
        END { if (!NR) print "is empty" }' "$folder/history.dat")
    [ -z "$damage" ] || fail "$folder/history.dat $damage; make the run again with --force, or continue it from a checkpoint"
done
command -v gnuplot >/dev/null || fail "'gnuplot' is not installed: run 'make deps'"
program_of() { sed -n '1s/^# \([a-z_]*\) .*/\1/p' "$1/case.toml"; }
program=$(program_of "$run")
# Two folders have two names.
name_of() {
    of=$(program_of "$1")
    case $1 in "out/$of/"*) name=${of}_${1#"out/$of/"} ;; *) name=$of--${1#/} ;; esac
    printf '%s\n' "$name" | sed 's|/|--|g'
}
plots=${PLOTS:-out/figures/$(name_of "$run")}
partial=$plots/.$$.png
case $run$other in *[\'\"\`\\]*) fail "gnuplot cannot read from a folder with quotes or a backslash in its name: $run $other" ;; esac

# What the lock in the folder of a run says: 9, it goes on; 0, it does not; another number, nothing.
lock_of() { says=2; [ ! -f "$1/.lock" ] || { says=0; flock -nsE 9 "$1/.lock" true 2>/dev/null || says=$?; }; }
entry() { awk -v key="$2" -f common/json_lines.awk "$1/summary.json" 2>/dev/null || true; }
# What the title of a picture says of a run that has not come to its end.
ended() {
    lock_of "$1"
    [ $says = 9 ] && status= || status=$(entry "$1" status)
    case $status in 0 | 1) return ;; '') verb='not ended' ;; ??*) verb='stopped' ;; *) verb='failed' ;; esac
    echo ", $verb at t = $(awk '$1 + 0 == $1 { t = $1 } END { printf "%.5g", t }' "$1/history.dat") of $(awk '/^\[/ { section = $1 } section == "[time]" && $1 == "end" { print $3 }' "$1/case.toml")"
}

# Does every condition of the line hold?
fits() {
    case "|$1|" in *"|$program|"* | '|any|') ;; *) return 1 ;; esac
    shift
    for condition; do
        value=${condition#*[=:]}
        case $condition in
        result:*) [ -f "$run/summary.json" ] && awk -v key="results.$value.value" -f common/json_lines.awk "$run/summary.json" | grep -q '^[-+.0-9]' ;;
        file:*) ls "$run"/$value >/dev/null 2>&1 ;;
        kinds:*)
            # With something in the last of them, below the three lines about it.
            kinds=$(for kind in $(echo "$value" | tr ',' ' '); do
                last=$(ls "$run/${kind}"_[0-9]*.dat 2>/dev/null | tail -n 1)
                [ -n "$last" ] && [ -n "$(sed -n 4p "$last")" ] && echo "$kind"
            done)
            [ -n "$kinds" ]
            ;;
        *!=*) fits any "${condition%%!=*}=$value" && return 1 || true ;;
        *=*) awk -v wanted="${condition%%=*}" -v values="$value" '
            /^\[/ { gsub(/[][]/, ""); section = $1 }
            section "." $1 == wanted && $2 == "=" { gsub(/"/, "", $3); found = index("|" values "|", "|" $3 "|") > 0 }
            END { exit !found }' "$run/case.toml" ;;
        *) fail "a figure cannot ask for '$condition'" ;;
        esac || return 1
    done
}

# Lines "SCRIPT" or "SCRIPT KIND" of all figures that fit.
figures() {
    for script in common/figures/*.gp ./*/figures/*.gp; do
        script=${script#./}
        conditions=$(sed -n 's/^# fits: //p' "$script")
        kinds=
        # shellcheck disable=SC2086
        [ -n "$conditions" ] && fits $conditions || continue
        for kind in ${kinds:-none}; do echo "$script ${kind#none}"; done
    done | sort -u
}

# draw SCRIPT [KIND]: one picture, under its name only when it is whole; of one that a full disk has cut off the end is missing.
draw() {
    picture=$plots/${2:-$(basename "$1" .gp)}.png
    mkdir -p "$plots"
    if gnuplot -e "run='$run'; out='$partial'; ended='$([ "$other" ] || ended "$run")'${2:+; kind='$2'}${other:+; other='$other'; heading='$heading'}" "$1" && tail -c 12 "$partial" | grep -aq IEND; then
        mv "$partial" "$picture"
    else
        rm -f "$partial"
        echo "$1 could not draw $run into $plots" >&2
        return 1
    fi
}

case $mode in
list) figures ;;
draw)
    lock_of "$run"
    [ -z "$(ended "$run")" ] || echo "note: $run$(ended "$run"). $([ $says = 9 ] || entry "$run" message)" >&2
    [ -n "${PLOTS:-}" ] || rm -f "$plots"/*.png  # a folder of the user's may hold other pictures
    figures | {
        status=0
        while read -r script kind; do
            if draw "$script" "$kind"; then echo "figure: $picture"; else status=1; fi
        done
        exit $status
    }
    ;;
watch)
    while :; do
        lock_of "$run"
        case $says in
        0) ended=yes ;;
        9) ended= ;;
        *) ended=$([ -f "$run/summary.json" ] && [ -z "$(find "$run/history.dat" -newer "$run/summary.json")" ] && echo yes || true) ;;
        esac
        if [ "${TEXT:-}" ]; then
            names=$(awk -f common/columns.awk "$run/history.dat" | awk '$2 == "energy" { unit = $3 } { name[NR] = $2; of[NR] = $3 } END { for (i = 2; i <= NR; i++) if (of[i] == unit && n++ < 4) print name[i] }')
            gnuplot -e "set terminal dumb $(tput cols || echo 100) 30; set title '$run' noenhanced; set key below noenhanced; plot for [name in '$names'] '$run/history.dat' using 'time':name with lines title name"
        else
            figures | grep '^common/figures/[hfp]' | while read -r script kind; do
                draw "$script" "$kind" && { [ "${told:-}" ] || echo "figure: $picture"; }
            done || [ -z "$ended" ]  # while it runs, the next picture may succeed
            told=yes
        fi
        [ -z "$ended" ] || break
        sleep "${EVERY:-5}"
    done
    ;;
compare)
    [ -n "$other" ] || fail "compare which two runs? A= and B="
    [ "$(sed -n 2p "$run/history.dat")" = "$(sed -n 2p "$other/history.dat")" ] ||
        echo "note: $run and $other record other columns, or in other units; the axes have those of $run" >&2
    heading="$run$(ended "$run") (solid) and $other$(ended "$other") (dashed)"
    plots=${PLOTS:-out/figures} partial=$plots/.$$.png
    draw common/figures/compare.gp "compare_$(name_of "$run")_$(name_of "$other")"
    echo "figure: $picture"
    ;;
movie) PLOTS=$plots ENDED=$(ended "$run") sh common/movie.sh "$run" ;;
esac
