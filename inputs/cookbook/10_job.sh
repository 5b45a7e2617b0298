#!/bin/bash
#SBATCH --nodes=1 --ntasks=1 --cpus-per-task=32
#SBATCH --time=04:00:00 --signal=B:TERM@120
set -euo pipefail
exec postproc/tanktread-sweep inputs/cookbook/10_study.yaml --jobs "${SLURM_CPUS_PER_TASK:-1}" \
    --plot D 'Membrane/capillary number' -o results/10_sweep_on_a_cluster.png
