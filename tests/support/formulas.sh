#!/bin/sh
# formulas.sh: every formula of the notes renders, and is written as GitHub shows it.
# Status 77 where node or KaTeX is missing: CTest calls that skipped.
set -eu
cd "$(dirname "$0")/../.."
if ! command -v node > /dev/null ||
    ! [ "$(node -p 'Boolean(require("./lecture_notes/book/formulas.js").folder)')" = true ]; then
    echo "skipped: node or KaTeX is missing; 'make deps-book' installs both"
    exit 77
fi
node lecture_notes/book/formulas.js check README.md ./*/README.md lecture_notes/*.md lecture_notes/*/*.md
