//! The scripts for Slurm, tried under a Slurm of our own: one node, this machine, in `target/slurm`. Only root can start it.

use crate::tally::Tally;
use crate::target::tools;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// How long Slurm may take for anything that takes it a second.
const LIMIT: Duration = Duration::from_secs(60);

/// A small campaign with every sort of unit, in the repository's root.
const CAMPAIGN: &str = r#"name = "slurm"
seeds = 3
[[scenario]]
file = "../../scenarios/channel.toml"
evaluations = 900
[[method]]
name = "mogp"
algorithm = "mogp"
motifs = "all"
[[method]]
name = "eh-grn"
algorithm = "eh-grn"
structure = 2
baseline = true
[[transfer]]
name = "two targets"
from = ["channel"]
file = "../../scenarios/channel-two-targets.toml"
[simulate]
realities = 2
"#;

/// Tries the scripts and compares what they leave with what one process leaves.
pub fn check(tally: &mut Tally) -> bool {
    let mut attempt = |name: &str, tried: Result<(), String>| {
        println!("test Slurm: {name} ... {}", if tried.is_ok() { "ok" } else { "FAILED" });
        let counter = if tried.is_ok() { &mut tally.passed } else { &mut tally.failed };
        *counter += 1;
        tried.inspect_err(|error| eprintln!("{error}")).is_ok()
    };
    let place = match provide().and_then(|()| Place::new()) {
        Ok(place) => place,
        Err(error) => return attempt("can be had", Err(error)),
    };
    let slurm = match place.start() {
        Ok(slurm) => slurm,
        Err(error) => return attempt("can be started", Err(error)),
    };
    let tries = [
        ("ranks of one job leave what one process leaves", slurm.ranks()),
        ("a job that was cancelled goes on", slurm.cancelled()),
        ("an array of parts is merged", slurm.array()),
    ];
    tries.into_iter().fold(true, |all, (name, tried)| attempt(name, tried) && all)
}

/// What it takes: Slurm, its authentication, MPI, and root.
fn provide() -> Result<(), String> {
    if said(Command::new("id").arg("-u"))?.trim() != "0" {
        return Err("Slurm's daemons start as root only: run this task as root, on a machine of your own".into());
    }
    crate::mpi::provide()?;
    tools::programs(&[("sbatch", &["slurm-wlm", "munge"]), ("munged", &["munge"])])
}

/// Where everything is: settings, logs, programs, campaigns.
struct Place {
    root: PathBuf,
    folder: PathBuf,
}

impl Place {
    /// A new place, with the command, the campaign, and what one process leaves of it.
    fn new() -> Result<Place, String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let root = root.canonicalize().map_err(|error| format!("{}: {error}", root.display()))?;
        let folder = root.join("target/slurm");
        // Of an earlier time.
        let _ = fs::remove_dir_all(&folder);
        let place = Place { root, folder };
        fs::create_dir_all(place.path("state")).map_err(|error| format!("{}: {error}", place.folder.display()))?;
        let build = ["build", "--quiet", "--workspace", "--bin", "grn", "--features", "host-evolver/mpi"];
        said(crate::this_cargo().args(build).current_dir(&place.root))?;
        place.write("campaign.toml", CAMPAIGN)?;
        let alone = place.path("alone");
        said(Command::new(place.grn()).arg("campaign").arg(place.path("campaign.toml")).arg("--out").arg(alone))?;
        Ok(place)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn grn(&self) -> PathBuf {
        self.root.join("target/debug/grn")
    }

    fn write(&self, name: &str, text: &str) -> Result<(), String> {
        let path = self.path(name);
        fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Starts the daemons.
    fn start(self) -> Result<Slurm, String> {
        let host = said(&mut Command::new("hostname"))?;
        let (host, folder) = (host.trim(), self.folder.display());
        let cores = thread::available_parallelism().map_or(1, usize::from).max(2);
        let settings = format!(
            "ClusterName=grn\nSlurmctldHost={host}(127.0.0.1)\nAuthType=auth/munge\nSlurmUser=root\nSlurmdUser=root\n\
             StateSaveLocation={folder}/state\nSlurmdSpoolDir={folder}/spool\nSlurmctldPidFile={folder}/slurmctld.pid\n\
             SlurmdPidFile={folder}/slurmd.pid\nSlurmctldLogFile={folder}/slurmctld.log\nSlurmdLogFile={folder}/slurmd.log\n\
             ProctrackType=proctrack/pgid\nTaskPlugin=task/none\nSelectType=select/cons_tres\n\
             SelectTypeParameters=CR_Core\nMpiDefault=none\nReturnToService=2\nKillWait=5\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs={cores}\nPartitionName=all Nodes={host} Default=YES State=UP\n"
        );
        self.write("slurm.conf", &settings)?;
        // One that runs already serves as well.
        if !answers(Command::new("munge").arg("-n")) {
            said(Command::new("install").args(["-d", "-o", "munge", "-g", "munge", "-m", "755", "/run/munge"]))?;
            said(Command::new("runuser").args(["-u", "munge", "--", "munged", "--force"]))?;
        }
        let slurm = Slurm { place: self };
        said(&mut slurm.command("slurmctld"))?;
        said(&mut slurm.command("slurmd"))?;
        slurm.wait("the node", |slurm| {
            said(slurm.command("sinfo").args(["-h", "-o", "%t"])).is_ok_and(|text| text.trim() == "idle")
        })?;
        Ok(slurm)
    }
}

/// A Slurm that runs until it is dropped.
struct Slurm {
    place: Place,
}

impl Slurm {
    /// A program of Slurm's, or one that uses it.
    fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.place.path("slurm.conf")).env("GRN", self.place.grn());
        command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
        command.current_dir(&self.place.folder);
        command
    }

    /// Submits a script; the number of its job.
    fn submit(&self, options: &[&str], script: &str, arguments: &[&Path]) -> Result<String, String> {
        let mut sbatch = self.command("sbatch");
        sbatch.arg("--parsable").args(options).arg(self.place.root.join("examples/slurm").join(script));
        Ok(said(sbatch.arg(self.place.path("campaign.toml")).args(arguments))?.trim().to_owned())
    }

    /// Waits until something is so.
    fn wait(&self, what: &str, is_so: impl Fn(&Slurm) -> bool) -> Result<(), String> {
        let start = Instant::now();
        while !is_so(self) {
            if start.elapsed() > LIMIT {
                return Err(format!("{what} does not come: see the logs in {}", self.place.folder.display()));
            }
            thread::sleep(Duration::from_millis(100));
        }
        Ok(())
    }

    fn wait_for_end(&self, job: &str) -> Result<(), String> {
        let is_over =
            |slurm: &Slurm| said(slurm.command("squeue").args(["-h", "-j", job])).map_or(true, |jobs| jobs.is_empty());
        self.wait(&format!("the end of job {job}"), is_over)
    }

    fn ranks(&self) -> Result<(), String> {
        let out = self.place.path("ranks");
        let job = self.submit(&[], "mpi.sh", &[Path::new("--out"), &out])?;
        self.wait_for_end(&job)?;
        self.same_as_alone(&out)
    }

    fn cancelled(&self) -> Result<(), String> {
        let out = self.place.path("cancelled");
        let job = self.submit(&[], "mpi.sh", &[Path::new("--out"), &out])?;
        self.wait("a first run", |_| files(&out.join("runs")).is_ok_and(|files| !files.is_empty()))?;
        said(self.command("scancel").arg(&job))?;
        self.wait_for_end(&job)?;
        if out.join("results.csv").exists() {
            return Err(format!("job {job} was done before it could be cancelled"));
        }
        let job = self.submit(&[], "mpi.sh", &[Path::new("--out"), &out])?;
        self.wait_for_end(&job)?;
        self.same_as_alone(&out)
    }

    fn array(&self) -> Result<(), String> {
        let out = self.place.path("array");
        let job = self.submit(&["--array=1-2"], "array.sh", &[&out])?;
        let merge = self.submit(&[&format!("--dependency=afterok:{job}")], "merge.sh", &[&out])?;
        self.wait_for_end(&merge)?;
        self.same_as_alone(&out.join("whole"))
    }

    fn same_as_alone(&self, folder: &Path) -> Result<(), String> {
        if files(folder)? == files(&self.place.path("alone"))? {
            return Ok(());
        }
        Err(format!("{} differs from alone in {}", folder.display(), self.place.folder.display()))
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        for daemon in ["slurmd.pid", "slurmctld.pid"] {
            if let Ok(pid) = fs::read_to_string(self.place.path(daemon)) {
                let _ = Command::new("kill").arg(pid.trim()).status();
            }
        }
    }
}

/// What a command printed that must succeed.
fn said(command: &mut Command) -> Result<String, String> {
    let described = format!("{command:?}");
    let output = command.stdin(Stdio::null()).output().map_err(|error| format!("{described}: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        return Ok(text);
    }
    Err(format!("{described}: {}\n{text}{}", output.status, String::from_utf8_lossy(&output.stderr)))
}

fn answers(command: &mut Command) -> bool {
    command.output().is_ok_and(|output| output.status.success())
}

/// The files below a folder by their paths in it, without locks.
fn files(folder: &Path) -> Result<BTreeMap<PathBuf, Vec<u8>>, String> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        let failed = |error: std::io::Error| format!("{}: {error}", next.display());
        for entry in fs::read_dir(&next).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.ends_with(".grn-lock") {
                let name = path.strip_prefix(folder).unwrap_or(&path).to_owned();
                found.insert(name, fs::read(&path).map_err(failed)?);
            }
        }
    }
    Ok(found)
}
