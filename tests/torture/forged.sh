# forged.sh: as inputs.sh, with nothing but forged checkpoints.
FUZZ_ONLY=forge
export FUZZ_ONLY
. tests/torture/inputs.sh
