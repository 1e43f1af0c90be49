# SPDX-License-Identifier: GPL-3.0-or-later
# start_slurm FOLDER: a Slurm of this machine alone, with all its files in an empty folder; sets
# SLURM_CONF. For root in namespaces of its own: run.sh says why.
start_slurm() {
  local folder=$1
  ip link set lo up
  ip address add 192.0.2.1/32 dev lo  # glibc resolves no name where 127.0.0.1 is the only address
  hostname localhost
  mkdir "$folder/state" "$folder/spool"
  export SLURM_CONF=$folder/slurm.conf
  cat > "$SLURM_CONF" << END_OF_CONF
ClusterName=binderjet
SlurmctldHost=localhost
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge.socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MailProg=/bin/true
NodeName=localhost CPUs=$(nproc)
PartitionName=all Nodes=ALL Default=YES
END_OF_CONF

  (umask 077 && head -c 128 /dev/urandom > "$folder/munge.key")
  munged --key-file="$folder/munge.key" --socket="$folder/munge.socket" \
    --pid-file="$folder/munge.pid" --seed-file="$folder/munge.seed" --log-file="$folder/munge.log"
  slurmctld -L "$folder/slurmctld.log"
  slurmd -L "$folder/slurmd.log"
}
