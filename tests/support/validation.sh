#!/bin/sh
# validation.sh: the page of the runs has a row for every verdict, with the numbers of the summary and
# nothing that a browser would take for a tag; without runs it says so.
set -eu
cd "$(dirname "$0")/../.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
trap 'exit 1' HUP INT TERM
page() { RUN_FOLDER=$scratch sh common/validation.sh body > "$scratch/page"; }
has() { grep -qF "$1" "$scratch/page" || { echo "the page lacks: $1"; exit 1; }; }

page
has 'There are no finished runs'

mkdir -p "$scratch/cic/one" "$scratch/cic/two"
cat > "$scratch/cic/one/summary.json" <<'END'
{"program": "cic", "version": "0.1.0", "results": {
  "growth": {"value": 0.35, "error": 0.001, "unit": "omega_p", "expected": 0.5, "tolerance": 0.01,
             "source": "theory, \"k < 1\"", "verdict": "FAIL"},
  "mode": {"value": 1.0, "unit": "", "source": "followed"}},
 "performance": {"wall_s": 2.5, "threads": 2.0}}
END
cat > "$scratch/cic/two/summary.json" <<'END'
{"program": "cic", "version": "0.1.0", "results": {
  "energy": {"value": 1e-9, "unit": "", "at_most": 0.05, "source": "energy", "verdict": "PASS"}},
 "performance": {"wall_s": 1.0, "threads": 2.0}}
END
page
has '<p>2 runs'
has '1 FAIL'
has '1 PASS'
has '<td><code>growth</code></td><td>0.35 omega_p</td><td>0.001</td><td>0.5</td><td>0.01</td><td><span class="FAIL">FAIL</span></td><td>theory, "k &lt; 1"</td>'
has '<td>1e-09 </td><td></td><td>at most 0.05</td>'
has 'Numbers without a verdict'
has '2.5 s on 2 threads'
