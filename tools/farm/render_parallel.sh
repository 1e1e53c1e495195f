#!/bin/bash
# A render by GNU parallel: chunks of the frames, here or on other machines over ssh that share the folder.
#
# usage: tools/farm/render_parallel.sh CHUNKS SCENE [OPTIONS of tenebra render]
#
# The same command again goes on: frames that are done are not drawn again. From the environment:
#   TENEBRA   the program [tenebra]
#   NODES     file of machines for parallel --sshloginfile [none: this one]
#   JOBS      chunks at a time on each machine [1: a render uses all cores]
#   LOGS      folder of the logs, one for each chunk, and of parallel's own; it must exist [.]
#   RETRIES   how often a chunk is tried [3]
set -euo pipefail

chunks=${1:?give the number of chunks}
shift
logs=${LOGS:-.}
where=()
if [[ -n ${NODES:-} ]]; then where=(--sshloginfile "$NODES" --workdir .); fi

# Whatever the options hold reaches the shells of the machines as it stands; {} is the chunk's number.
command="$(printf '%q ' "${TENEBRA:-tenebra}" render "$@") --resume --quiet --chunk {}/$chunks"
command+=" --log $(printf '%q' "$logs")/chunk_{}.csv"
exec parallel "${where[@]}" --jobs "${JOBS:-1}" --retries "${RETRIES:-3}" \
  --joblog "$logs/parallel.log" "$command" ::: $(seq "$chunks")
