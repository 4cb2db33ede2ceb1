#!/bin/sh
# The runs of a campaign as single jobs, without MPI: sbatch --array=1-8 array.sh CAMPAIGN.toml FOLDER
# Each fills FOLDER/part-1, FOLDER/part-2, …; merge.sh makes one of them.
#SBATCH --job-name=grn-part
#SBATCH --ntasks=1
#SBATCH --time=24:00:00
#SBATCH --output=grn-%A-%a.log
# Two minutes before the time is over; submitted again, the same array goes on.
#SBATCH --signal=B:TERM@120
exec "${GRN:-grn}" campaign "$1" --out "$2/part-$SLURM_ARRAY_TASK_ID" \
  --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT"
