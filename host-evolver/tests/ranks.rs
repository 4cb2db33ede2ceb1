//! `grn campaign` under mpirun, as a researcher on a cluster uses it: any number of ranks, stopped and killed. The ranks are processes
//! of this machine.

mod support;

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;
use support::desk::{CAMPAIGN, Desk, edited};
use support::{Outcome, content, text};

type Files = Vec<(PathBuf, Vec<u8>)>;

/// Two methods, three seeds, trials and simulations: every sort of unit.
fn written(desk: &Desk) -> std::io::Result<PathBuf> {
    let text = edited(CAMPAIGN, "seeds = 1", "seeds = 3");
    let text = edited(&text, "evaluations = 800", "evaluations = 900");
    std::fs::write(
        desk.path("campaign.toml"),
        edited(&text, "[vary]\nlevel = [0.9, 1.1]\n", "[simulate]\nrealities = 2\n"),
    )?;
    Ok(desk.path("campaign.toml"))
}

fn mpirun(ranks: usize) -> Command {
    let mut command = Command::new("mpirun");
    command.args(["--oversubscribe", "-n", &ranks.to_string()]).arg(env!("CARGO_BIN_EXE_grn"));
    command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

fn campaign(ranks: usize, file: &Path, out: &Path) -> Command {
    let mut command = mpirun(ranks);
    command.arg("campaign").arg(file).arg("--out").arg(out);
    command
}

/// What the same program leaves without mpirun.
fn alone(desk: &Desk, file: &Path) -> Result<Files, Box<dyn std::error::Error>> {
    let out = desk.path("alone");
    let mut command = Command::new(env!("CARGO_BIN_EXE_grn"));
    assert_done(&command.arg("campaign").arg(file).arg("--out").arg(&out).output()?);
    Ok(content(&out)?)
}

fn assert_done(output: &Output) {
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
}

fn signal(name: &str, process: u32) -> std::io::Result<bool> {
    Ok(Command::new("kill").args(["-s", name, &process.to_string()]).stderr(Stdio::null()).status()?.success())
}

/// The ranks that a mpirun has started, by their process numbers.
fn ranks_of(mpirun: &Child) -> std::io::Result<Vec<u32>> {
    let number = mpirun.id();
    let children = std::fs::read_to_string(format!("/proc/{number}/task/{number}/children"))?;
    Ok(children.split_whitespace().filter_map(|child| child.parse().ok()).collect())
}

#[test]
fn any_number_of_ranks_leaves_the_bytes_of_one_process() -> Outcome {
    let desk = Desk::new()?;
    let file = written(&desk)?;
    let expected = alone(&desk, &file)?;
    for (ranks, threads) in [(1, "1"), (2, "1"), (2, "2"), (4, "1")] {
        let out = desk.path(&format!("{ranks}-{threads}"));
        let output = campaign(ranks, &file, &out).args(["--threads", threads]).output()?;
        assert_done(&output);
        assert_eq!(text(&output.stdout).matches("tables and figures in").count(), 1, "one rank speaks");
        assert!(content(&out)? == expected, "{ranks} ranks of {threads} threads leave something else");
    }
    Ok(())
}

#[test]
fn whichever_rank_is_killed_the_same_command_goes_on_to_the_same_bytes() -> Outcome {
    let kills: usize = std::env::var("GRN_KILLS").ok().map_or(Ok(8), |kills| kills.parse())?;
    let desk = Desk::new()?;
    let file = written(&desk)?;
    let expected = alone(&desk, &file)?;
    let out = desk.path("killed");
    let mut ended = 0;
    for kill in 0..kills {
        let mut child = campaign(3, &file, &out).stdout(Stdio::null()).stderr(Stdio::null()).spawn()?;
        std::thread::sleep(Duration::from_millis(300 + (kill as u64 * 617) % 1500));
        // Sometimes mpirun itself.
        let mut victims = ranks_of(&child).unwrap_or_default();
        victims.push(child.id());
        signal("KILL", victims[kill % victims.len()])?;
        ended += usize::from(!child.wait()?.success());
        // Ranks whose mpirun has died notice it themselves, and the next command waits for the folder.
        wait_until_free(&out)?;
    }
    assert!(ended > 0, "no kill met a campaign under way");
    let output = campaign(3, &file, &out).output()?;
    assert_done(&output);
    assert!(content(&out)? == expected, "killed {kills} times the result is another");
    Ok(())
}

/// Waits until nobody holds the lock of a folder.
fn wait_until_free(folder: &Path) -> std::io::Result<()> {
    for _ in 0..300 {
        let Ok(lock) = std::fs::File::open(folder.join(".grn-lock")) else { return Ok(()) };
        if lock.try_lock_shared().is_ok() {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Err(std::io::Error::other("somebody still writes the folder"))
}

/// What has been made of a campaign so far: how many files of runs, trials and simulations.
fn made(folder: &Path) -> usize {
    let made = content(folder).unwrap_or_default();
    // Not what is still being written, nor what was tried before anything was made.
    let is_whole = |path: &Path| !path.components().any(|part| part.as_os_str().to_string_lossy().starts_with('.'));
    made.iter().filter(|(path, _)| path.components().count() > 1 && is_whole(path)).count()
}

/// Waits until more has been made than there was. Then all ranks are at work, however slow the machine is, and hear signals: a rank or an mpirun
/// that has only been started dies of them.
fn wait_for_more(folder: &Path, before: usize) -> std::io::Result<()> {
    for _ in 0..2400 {
        if made(folder) > before {
            return Ok(());
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Err(std::io::Error::other(format!("nothing comes beyond {before} files")))
}

#[test]
fn a_stop_ends_all_ranks_in_order_and_what_was_done_is_kept() -> Outcome {
    let desk = Desk::new()?;
    let file = written(&desk)?;
    let expected = alone(&desk, &file)?;
    let out = desk.path("stopped");
    // What mpirun passes on, and what a scheduler sends to each rank: here to one that does not lead.
    for to_mpirun in [true, false] {
        let before = made(&out);
        let child = campaign(3, &file, &out).spawn()?;
        wait_for_more(&out, before)?;
        match ranks_of(&child)?.last() {
            Some(&last) if !to_mpirun => signal("TERM", last)?,
            _ => signal("USR1", child.id())?,
        };
        let output = child.wait_with_output()?;
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(130), "{told}");
        assert_eq!(told.matches("go on with the same command").count(), 1, "{told}");
    }
    // Ctrl-C: mpirun ends the ranks and says 1 itself.
    let before = made(&out);
    let child = campaign(3, &file, &out).spawn()?;
    wait_for_more(&out, before)?;
    signal("INT", child.id())?;
    assert!(!child.wait_with_output()?.status.success());
    wait_until_free(&out)?;
    assert_done(&campaign(2, &file, &out).output()?);
    assert!(content(&out)? == expected, "stopped and gone on with, the result is another");
    Ok(())
}

#[test]
fn ranks_that_see_different_campaigns_and_campaigns_that_are_wrong_are_refused() -> Outcome {
    let desk = Desk::new()?;
    let file = written(&desk)?;
    let other = desk.path("other.toml");
    std::fs::write(&other, edited(&std::fs::read_to_string(&file)?, "seeds = 3", "seeds = 4"))?;
    for (second, words) in
        [(other, "has another grn, other files"), (desk.path("missing.toml"), "missing.toml: cannot be read")]
    {
        let mut command = campaign(1, &file, &desk.path("out"));
        command.args([":", "-n", "1"]).arg(env!("CARGO_BIN_EXE_grn")).arg("campaign").arg(second);
        let output = command.output()?;
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("rank 1 on ") && told.contains(words), "{words:?} is not in {told}");
    }
    let output = campaign(2, &desk.path("missing.toml"), &desk.path("out")).output()?;
    let told = text(&output.stderr);
    assert_eq!((output.status.code(), told.matches("grn: ").count()), (Some(2), 1), "{told}");
    Ok(())
}
