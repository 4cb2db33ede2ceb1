//! `grn flash`.

use super::connection::{self, CONNECT_LIMIT, ConnectionError, DEFAULT_BAUD, hexadecimal};
use super::{Answer, Failure, about, interrupt, options, output, take_folder};
use crate::files::{blob_bytes, read_blob};
use crate::sectors::Sector;
use crate::slot_file::{Programmer, SlotFile, SlotPaths, UploadNumber};
use grn_core::blob::{Blob, FORMAT_VERSION};
use grn_core::robot::Controller;
use grn_core::robot::link::Refusal;
use grn_core::robot::link::frame::MAX_WIRE;
use grn_core::robot::link::message::{About, Begin, Chunk, MAX_CHUNK, encode_request};
use grn_core::robot::link::server::TRIAL_TICKS;
use grn_core::scalar::{NumberType, Q8_24};
use grn_link::flashing::{self, Flashed, Progress};
use grn_link::{Client, LinkError, Patience, Port, Wire};
use indicatif::{ProgressBar, ProgressStyle};
use std::cell::Cell;
use std::fmt;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

#[derive(clap::Args)]
#[command(group(clap::ArgGroup::new("destination").required(true).args(["to", "out"])))]
pub struct Arguments {
    /// The controller.
    blob: PathBuf,
    /// The robot: a serial port, tcp:HOST:PORT or unix:PATH.
    #[arg(long, value_name = "PORT")]
    to: Option<Port>,
    /// Baud rate of a serial port.
    #[arg(long, default_value_t = DEFAULT_BAUD, value_parser = options::baud, allow_hyphen_values = true)]
    baud: u32,
    /// Leave the blob on trial: the robot keeps it after 64 ticks, and goes back to the old one if it is reset before.
    #[arg(long, conflicts_with = "out")]
    trial: bool,
    /// Instead, write slot.hex, slot.bin and flash.gdb for a programmer into this folder.
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Where the slot begins in the robot's flash, for --out: 0x08080000 or 0x080A0000 for the e-puck2's C firmware,
    /// 0x08008000 or 0x0800C000 for grn's own image.
    #[arg(long, default_value_t = Sector::DEFAULT, conflicts_with = "to", allow_hyphen_values = true)]
    address: Sector,
    /// Write the slot even where the robot's firmware keeps something else.
    #[arg(long, conflicts_with = "to")]
    force: bool,
    /// Number of this upload, for --out: the robot takes the slot with the higher one [default: seconds since 1970].
    #[arg(long, conflicts_with = "to", allow_hyphen_values = true)]
    sequence: Option<UploadNumber>,
    /// Serial port of the robot's programmer, for flash.gdb.
    #[arg(long, default_value = Programmer::DEFAULT, conflicts_with = "to")]
    programmer: Programmer,
    /// Number type the robot computes in; without it a blob for --out or --dry-run must fit all [f32, q8.24].
    #[arg(long)]
    number: Option<NumberType>,
    /// Only say what would be sent or written.
    #[arg(long)]
    dry_run: bool,
}

pub fn run(arguments: &Arguments) -> Result<Answer, Failure> {
    let place = arguments.blob.display();
    let blob = read_blob(&arguments.blob)?;
    // A blob is canonical: its file has just the bytes that it encodes to.
    let bytes = blob_bytes(&blob).map_err(|error| about(&place)(error).of_program())?;
    // A robot that is asked itself says what it computes in.
    if arguments.out.is_some() || arguments.dry_run {
        check_fit(&blob, arguments.number).map_err(unfit(&place))?;
    }
    match (&arguments.to, &arguments.out) {
        (Some(port), _) if arguments.dry_run => rehearse(port, &bytes, &blob, arguments.trial),
        (Some(port), _) => upload(port, &bytes, &blob, arguments),
        (None, Some(folder)) => write(folder, &bytes, arguments),
        (None, None) => Err(Failure::Input("--to or --out is needed".into())),
    }
}

fn unfit(place: impl fmt::Display) -> impl FnOnce(String) -> Failure {
    move |fault| Failure::Input(fault).about(place)
}

/// Refuses what no robot of this number type, or of one of them, could drive with; in the words of such a robot.
fn check_fit(blob: &Blob, number: Option<NumberType>) -> Result<(), String> {
    let fits = |number| match number {
        NumberType::F32 => Controller::<f32>::new(blob, 0).map(|_| ()),
        NumberType::Q8_24 => Controller::<Q8_24>::new(blob, 0).map(|_| ()),
    };
    let asked: Vec<NumberType> = number.map_or(NumberType::ALL.to_vec(), |number| vec![number]);
    let Some((unfit, error)) = asked.iter().find_map(|&number| fits(number).err().map(|error| (number, error))) else {
        return Ok(());
    };
    let told = format!("it cannot drive a robot that computes in {unfit}: {}", Refusal::from(error));
    Err(match asked.into_iter().find(|&number| fits(number).is_ok()) {
        Some(fit) => format!("{told}; or add --number {fit} if your robots compute in {fit}"),
        None => told,
    })
}

fn upload(port: &Port, bytes: &[u8], blob: &Blob, arguments: &Arguments) -> Result<Answer, Failure> {
    let identity = blob.identity();
    let failed = |error: ConnectionError| connection::failed(port, error);
    let wire = port.open(arguments.baud, CONNECT_LIMIT).map_err(|error| failed(error.into()))?;
    let interrupted = interrupt::watch()?;
    let wire = Interruptible { wire, interrupted: Arc::clone(&interrupted) };
    let step = Cell::new(Progress::Erasing);
    let unless_interrupted = |error: LinkError| {
        if interrupted.load(Ordering::Relaxed) {
            return Failure::Interrupted(format!("{port}: {}", aftermath(port, step.get())));
        }
        failed(error.into())
    };
    let (mut client, robot) = Client::connect(wire, Patience::default()).map_err(unless_interrupted)?;
    check(&robot, bytes, blob, arguments.number).map_err(unfit(port))?;
    let style = ProgressStyle::with_template("{msg:11} {bar:40} {bytes}/{total_bytes}");
    let bar = ProgressBar::new(bytes.len() as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
    let flashed = flashing::flash(&mut client, bytes, identity, !arguments.trial, |progress| {
        step.set(progress);
        let (done, name) = match progress {
            Progress::Erasing => (0, "erasing"),
            Progress::Uploading(done) => (done, "uploading"),
            Progress::Verifying => (bytes.len(), "verifying"),
            Progress::Activating => (bytes.len(), "activating"),
            Progress::Confirming => (bytes.len(), "confirming"),
        };
        bar.set_message(name);
        bar.set_position(done as u64);
    });
    bar.finish_and_clear();
    let was = match flashed.map_err(unless_interrupted)? {
        Flashed::InCharge => "is in charge",
        Flashed::WasInCharge => "was in charge already",
    };
    let trial = if arguments.trial {
        format!(", on trial for {TRIAL_TICKS} ticks: `grn confirm {port}` keeps it, `grn rollback {port}` does not")
    } else {
        String::new()
    };
    output::report(format!("{port}: {} on {} {was}{trial}", hexadecimal(&identity), robot.name));
    Ok(Answer::Yes)
}

/// What an interrupted upload leaves on the robot.
fn aftermath(port: &Port, step: Progress) -> String {
    match step {
        Progress::Erasing | Progress::Uploading(_) | Progress::Verifying => {
            "the robot keeps the blob that was in charge; the upload can be repeated".into()
        }
        Progress::Activating => format!("the old or the new blob is in charge; `grn robots {port}` tells which"),
        Progress::Confirming => format!("the new blob is in charge, perhaps still on trial; `grn robots {port}` tells"),
    }
}

/// A wire that fails as soon as the user presses Ctrl-C.
struct Interruptible<W> {
    wire: W,
    interrupted: Arc<AtomicBool>,
}

impl<W> Interruptible<W> {
    fn check(&self) -> io::Result<()> {
        if self.interrupted.load(Ordering::Relaxed) { Err(io::ErrorKind::Interrupted.into()) } else { Ok(()) }
    }
}

impl<W: Wire> Wire for Interruptible<W> {
    fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.check()?;
        self.wire.send(bytes)
    }

    fn receive(&mut self, buffer: &mut [u8], patience: Duration) -> io::Result<usize> {
        const SLICE: Duration = Duration::from_millis(50);
        let deadline = Instant::now() + patience;
        loop {
            self.check()?;
            let left = deadline.saturating_duration_since(Instant::now());
            let count = if left.is_zero() { 0 } else { self.wire.receive(buffer, left.min(SLICE))? };
            if count > 0 || left.is_zero() {
                return Ok(count);
            }
        }
    }
}

/// What can be told before anything is erased.
fn check(robot: &About, bytes: &[u8], blob: &Blob, number: Option<NumberType>) -> Result<(), String> {
    if let Some(number) = number.filter(|&number| number != robot.number_type) {
        return Err(format!("the robot computes in {}, not in {number}: leave out --number", robot.number_type));
    }
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
    check_fit(blob, Some(robot.number_type))
}

fn rehearse(port: &Port, bytes: &[u8], blob: &Blob, trial: bool) -> Result<Answer, Failure> {
    let identity = blob.identity();
    output::product(format!("{port}: nothing is sent. Blob {}, {} bytes:", hexadecimal(&identity), bytes.len()))?;
    let begin = encode_request(3, &Begin { length: bytes.len() as u32, identity });
    let show = |what: &str, frame: Option<heapless::Vec<u8, MAX_WIRE>>| {
        output::product(format!("  {what:<28}{}", hexadecimal(&frame.unwrap_or_default())))
    };
    show("begin", begin.ok())?;
    for (place, piece) in bytes.chunks(MAX_CHUNK).enumerate() {
        let offset = (place * MAX_CHUNK) as u32;
        let chunk = Chunk { offset, bytes: piece.iter().copied().collect() };
        let frame = encode_request(4 + place as u8, &chunk);
        show(&format!("chunk at {offset}, {} bytes", piece.len()), frame.ok())?;
    }
    output::product(format!("then: verify, activate{}", if trial { " (on trial)" } else { ", confirm" }))?;
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
    output::notice(format_args!("grn: warning: {told}"));
    Ok(())
}

fn write(folder: &std::path::Path, bytes: &[u8], arguments: &Arguments) -> Result<Answer, Failure> {
    check_sector(arguments.address, arguments.force)?;
    let sequence = arguments.sequence.map_or_else(UploadNumber::of_clock, Ok).map_err(|_| {
        Failure::System(
            "this machine's clock shows a time before 1970 or after 2096; set it, or give --sequence".into(),
        )
    })?;
    let file = SlotFile::new(bytes, arguments.address, sequence).map_err(about(arguments.blob.display()))?;
    let paths = SlotPaths::in_folder(folder)?;
    let would = if arguments.dry_run { "would be written" } else { "written" };
    let last = file.address + file.bytes.len() as u32 - 1;
    if !arguments.dry_run {
        let _lock = take_folder(folder)?;
        file.write(&paths, &arguments.programmer)?;
    }
    let [hex, binary, script] = SlotPaths::NAMES.map(|name| folder.join(name));
    let told = format!(
        "{:#010x} to {last:#010x}, upload number {sequence}; {would}:\n  {}, {}, {}\n\
         with the e-puck2's programmer on {}:\n  {}\nover USB DFU:\n  {}",
        file.address,
        hex.display(),
        binary.display(),
        script.display(),
        arguments.programmer,
        paths.gdb_line(),
        file.dfu_line(&paths)
    );
    if arguments.dry_run {
        output::product(told)?;
    } else {
        output::report(told);
    }
    Ok(Answer::Yes)
}
