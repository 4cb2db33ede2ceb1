#!/bin/sh
# Trials, simulations, tables and figures of what array.sh has made:
# sbatch --dependency=afterok:JOB merge.sh CAMPAIGN.toml FOLDER
#SBATCH --job-name=grn-merge
#SBATCH --ntasks=1
#SBATCH --time=24:00:00
#SBATCH --output=grn-%j.log
#SBATCH --signal=B:TERM@120
campaign=$1
folder=$2
set --
for part in "$folder"/part-*; do
  set -- "$@" --merge "$part"
done
exec "${GRN:-grn}" campaign "$campaign" --out "$folder/whole" "$@"
