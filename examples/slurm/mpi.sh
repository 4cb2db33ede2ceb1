#!/bin/sh
# One campaign on all nodes of a job, by MPI: sbatch mpi.sh CAMPAIGN.toml [OPTIONS OF GRN CAMPAIGN]
# A job that ends early, by its time limit, scancel or a node that dies, goes on when it is submitted again.
#SBATCH --job-name=grn
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=2
#SBATCH --time=24:00:00
#SBATCH --output=grn-%j.log
# Two minutes before the time is over: mpirun passes it on, and every rank ends in order.
#SBATCH --signal=B:USR1@120
# In place of the shell, which would keep the signal to itself.
exec mpirun ${GRN_MPIRUN:-} "${GRN:-grn}" campaign "$@"
