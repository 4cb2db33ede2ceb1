//! `grn flash`.

use super::{Answer, Failure, about, print};
use crate::sectors::Sector;
use crate::slot_file::{Programmer, SlotFile, SlotPaths};
use grn_core::blob::{Blob, FORMAT_VERSION};
use grn_core::robot::link::frame::MAX_WIRE;
use grn_core::robot::link::message::{About, MAX_CHUNK, encode_request};
use grn_core::robot::link::message::{Begin, Chunk};
use grn_link::flashing::{self, Flashed, Progress};
use grn_link::{Client, Patience, Port};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

/// Baud rate of serial ports when nothing else is said.
pub const DEFAULT_BAUD: u32 = 115_200;

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("destination").required(true).args(["to", "out"])))]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// The robot: a serial port, tcp:HOST:PORT or unix:PATH.
    #[arg(long, value_name = "PORT")]
    to: Option<Port>,
    /// Baud rate of a serial port.
    #[arg(long, default_value_t = DEFAULT_BAUD)]
    baud: u32,
    /// Leave the blob on trial: the robot keeps it after 64 ticks, and goes back to the old one if it is reset before.
    #[arg(long, conflicts_with = "out")]
    trial: bool,
    /// Instead, write slot.hex, slot.bin and flash.gdb for a programmer into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Where the slot begins in the robot's flash, for --out: 0x08080000 or 0x080A0000 for the e-puck2's C firmware,
    /// 0x08008000 or 0x0800C000 for grn's own image.
    #[arg(long, default_value_t = Sector::DEFAULT, conflicts_with = "to")]
    address: Sector,
    /// Write the slot even where the robot's firmware keeps something else.
    #[arg(long, conflicts_with = "to")]
    force: bool,
    /// Number of this upload, for --out: the robot takes the slot with the higher one [default: seconds since 1970].
    #[arg(long, conflicts_with = "to")]
    sequence: Option<u32>,
    /// Serial port of the robot's programmer, for flash.gdb.
    #[arg(long, default_value = Programmer::DEFAULT, conflicts_with = "to")]
    programmer: Programmer,
    /// Only say what would be sent or written.
    #[arg(long)]
    dry_run: bool,
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let place = arguments.blob.display();
    let bytes = std::fs::read(&arguments.blob).map_err(|error| about(&place)(format!("cannot be read: {error}")))?;
    let blob = Blob::decode(&bytes).map_err(about(&place))?;
    match (&arguments.to, &arguments.out) {
        (Some(port), _) if arguments.dry_run => rehearse(port, &bytes, &blob, arguments.trial),
        (Some(port), _) => upload(port, &bytes, &blob, arguments),
        (None, Some(folder)) => write(folder, &bytes, arguments),
        (None, None) => Err(Failure::Input("--to or --out is needed".into())),
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn upload(port: &Port, bytes: &[u8], blob: &Blob, arguments: &Arguments) -> Result<Answer, Failure> {
    let identity = blob.identity();
    let wire = port.open(arguments.baud).map_err(about(port))?;
    let (mut client, robot) = Client::connect(wire, Patience::default()).map_err(about(port))?;
    check(&robot, bytes, blob).map_err(about(port))?;
    let style = ProgressStyle::with_template("{msg:11} {bar:40} {bytes}/{total_bytes}");
    let bar = ProgressBar::new(bytes.len() as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let flashed = flashing::flash(&mut client, bytes, identity, !arguments.trial, |progress| {
        let (done, step) = match progress {
            Progress::Erasing => (0, "erasing"),
            Progress::Uploading(done) => (done, "uploading"),
            Progress::Verifying => (bytes.len(), "verifying"),
            Progress::Activating => (bytes.len(), "activating"),
            Progress::Confirming => (bytes.len(), "confirming"),
        };
        bar.set_message(step);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let flashed = flashed.map_err(about(port))?;
    let was = match flashed {
        Flashed::InCharge => "is in charge",
        Flashed::WasInCharge => "was in charge already",
    };
    let trial = if arguments.trial { ", on trial for 64 ticks" } else { "" };
    print(format!("{port}: {} on {} {was}{trial}", hexadecimal(&identity), robot.name))?;
    Ok(Answer::Yes)
}

/// What can be told before anything is erased.
fn check(robot: &About, bytes: &[u8], blob: &Blob) -> Result<(), String> {
    let genes = blob.network.genes().len();
    if robot.blob_format != FORMAT_VERSION {
        let way_out = "use the release of grn that belongs to the firmware, or update the firmware";
        return Err(format!("the robot reads blob format {}, this is {FORMAT_VERSION}: {way_out}", robot.blob_format));
    }
    if genes > usize::from(robot.genes) || bytes.len() > usize::from(robot.blob_bytes) {
        let way_out = "choose a smaller front member, or build the firmware for more";
        let (most, room) = (robot.genes, robot.blob_bytes);
        return Err(format!("{genes} genes in {} bytes, the robot holds {most} in {room}: {way_out}", bytes.len()));
    }
    Ok(())
}

fn rehearse(port: &Port, bytes: &[u8], blob: &Blob, trial: bool) -> Result<Answer, Failure> {
    let identity = blob.identity();
    print(format!("{port}: nothing is sent. Blob {}, {} bytes:", hexadecimal(&identity), bytes.len()))?;
    let begin = encode_request(3, &Begin { length: bytes.len() as u32, identity });
    let show = |what: &str, frame: Option<heapless::Vec<u8, MAX_WIRE>>| {
        print(format!("  {what:<28}{}", hexadecimal(&frame.unwrap_or_default())))
    };
    show("begin", begin.ok())?;
    for (place, piece) in bytes.chunks(MAX_CHUNK).enumerate() {
        let offset = (place * MAX_CHUNK) as u32;
        let chunk = Chunk { offset, bytes: piece.iter().copied().collect() };
        let frame = encode_request(4 + place as u8, &chunk);
        show(&format!("chunk at {offset}, {} bytes", piece.len()), frame.ok())?;
    }
    print(format!("then: verify, activate{}", if trial { " (on trial)" } else { ", confirm" }))?;
    Ok(Answer::Yes)
}

/// Refuses a sector that holds something else, unless it is forced; then says what will happen.
fn check_sector(sector: Sector, force: bool) -> Result<(), Failure> {
    let Some(danger) = sector.content().danger() else { return Ok(()) };
    let told = format!("--address {sector} is sector {} of the flash: {danger}", sector.number());
    if !force {
        let way_out = format!("leave out --address for {}, or add --force if this is meant", Sector::DEFAULT);
        return Err(Failure::Input(format!("{told}; {way_out}")));
    }
    // Whoever closed standard error does not want to know.
    let _ = writeln!(std::io::stderr(), "grn: warning: {told}");
    Ok(())
}

fn write(folder: &std::path::Path, bytes: &[u8], arguments: &Arguments) -> Result<Answer, Failure> {
    check_sector(arguments.address, arguments.force)?;
    let now = SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs() as u32);
    let sequence = arguments.sequence.unwrap_or(now);
    let file = SlotFile::new(bytes, arguments.address, sequence).map_err(about(arguments.blob.display()))?;
    let paths = SlotPaths::in_folder(folder)?;
    let would = if arguments.dry_run { "would be written" } else { "written" };
    let last = file.address + file.bytes.len() as u32 - 1;
    if !arguments.dry_run {
        file.write(&paths, &arguments.programmer)?;
    }
    print(format!("{:#010x} to {last:#010x}, upload number {sequence}; {would}:", file.address))?;
    for name in SlotPaths::NAMES {
        print(format!("  {}", folder.join(name).display()))?;
    }
    print(format!("with the e-puck2's programmer on {}:", arguments.programmer))?;
    print(format!("  {}", paths.gdb_line()))?;
    print(format!("over USB DFU:\n  {}", file.dfu_line(&paths)))?;
    Ok(Answer::Yes)
}
