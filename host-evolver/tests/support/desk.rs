//! A folder with a small world, a campaign and a blob, for trying what is wrong with them.
#![allow(dead_code, reason = "every test file uses a part of it")]

use super::{Outcome, model};
use std::path::PathBuf;
use std::process::{Command, Output};

pub const WORLD: &str = r#"name = "world"
region = [20.0, 20.0]
snapshots = 15
[morphogen]
kernel = "gaussian"
target_width = 1.5
obstacle_width = 0.9
level = 0.5
[ring]
d_min = 1.0
d_max = 2.0
d_obstacle = 2.0
steepness = 10.0
[[target]]
path = [[3.0, 10.0], [17.0, 10.0]]
[[wall]]
polygon = [[6.0, 14.0], [14.0, 14.0], [14.0, 20.0], [6.0, 20.0]]
[[wall]]
polygon = [[6.0, 0.0], [14.0, 0.0], [14.0, 6.0], [6.0, 6.0]]
"#;

pub const CAMPAIGN: &str = r#"name = "campaign"
seeds = 1
[[scenario]]
file = "world.toml"
evaluations = 800
[[method]]
name = "m"
algorithm = "mogp"
motifs = "all"
[[method]]
name = "e"
algorithm = "eh-grn"
structure = 2
[[model]]
name = "printed"
file = "blob.grn"
[[transfer]]
name = "thrown"
from = ["world"]
file = "world.toml"
random = { worlds = 3, seed = 1, density = 0.03, radius = [0.3, 0.6], clearance = 1.5 }
[vary]
level = [0.9, 1.1]
"#;

/// A folder with a world, a campaign and a blob.
pub struct Desk(tempfile::TempDir);

impl Desk {
    pub fn new() -> std::io::Result<Desk> {
        let desk = Desk(tempfile::tempdir()?);
        std::fs::copy(model(), desk.path("blob.grn"))?;
        std::fs::write(desk.path("world.toml"), WORLD)?;
        std::fs::write(desk.path("campaign.toml"), CAMPAIGN)?;
        Ok(desk)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn files(&self) -> std::io::Result<Vec<PathBuf>> {
        let mut files: Vec<_> =
            std::fs::read_dir(self.0.path())?.map(|e| e.map(|e| e.path())).collect::<Result<_, _>>()?;
        files.sort();
        Ok(files)
    }

    /// Runs grn here, on Unix with at most 4 GB of addresses.
    pub fn grn(&self, arguments: &[&str]) -> std::io::Result<Output> {
        let program = env!("CARGO_BIN_EXE_grn");
        let mut command = if cfg!(unix) {
            let mut shell = Command::new("sh");
            shell.args(["-c", "ulimit -v 4000000; exec \"$0\" \"$@\"", program]);
            shell
        } else {
            Command::new(program)
        };
        command.args(arguments).current_dir(self.0.path()).env_remove("RUST_BACKTRACE").output()
    }

    /// Whether a command is refused with these words on its first line.
    pub fn refuses(&self, arguments: &[&str], words: &[&str], what: &str) -> Outcome {
        let before = self.files()?;
        let output = self.grn(arguments)?;
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        let first = message.lines().next().unwrap_or_default();
        let missing: Vec<_> = words.iter().filter(|word| !first.contains(**word)).collect();
        let is_right = output.status.code() == Some(2) && !message.contains("panicked") && missing.is_empty();
        if is_right && self.files()? == before {
            return Ok(());
        }
        Err(format!("{what}: {:?}, without {missing:?}, leaves {:?}: {message}", output.status.code(), self.files()?)
            .into())
    }
}

pub fn edited(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}");
    text.replacen(from, to, 1)
}
