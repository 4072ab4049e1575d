#!/usr/bin/env bash
# SPDX-License-Identifier: AGPL-3.0-or-later
# A sharded sweep as a Slurm job array; see README.md beside this file. For example
#   sbatch --array=0-63 scripts/slurm/sweep-array.sh -j shoulder.artus --draw 1000000 --seed 7 --out /data/set
# A task may be killed and started again at any time: it goes on with the first shard that is not there.
#SBATCH --job-name=artus-sweep
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail
: "${SLURM_ARRAY_TASK_ID:?start this with sbatch --array=0-N}"
first=${SLURM_ARRAY_TASK_MIN:-0}
turn=$((SLURM_ARRAY_TASK_ID - first))
exec "${ARTUS:-artus}" sweep --shard "$turn/$SLURM_ARRAY_TASK_COUNT" --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
