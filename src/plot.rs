//! `tiltrotor plot`.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use logs::output::{self, Output};
use logs::text::size;
use replay::figures::{Figure, Flight, Undrawn, draw};

use crate::afterwards::Afterwards;
use crate::status::Status;
use crate::window::WindowArgs;

/// Pixels of a PNG a point: 144 to the inch.
const PIXELS_PER_POINT: f64 = 2.0;

/// What to draw.
#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// Another log over it: each has its colour, named in every legend
    #[arg(long, value_name = "OTHER")]
    against: Option<PathBuf>,
    /// The folder for the figures; made where it is missing [default: the log's]
    #[arg(long, value_name = "FOLDER")]
    out: Option<PathBuf>,
    /// Only these figures; all of them without
    #[arg(long, value_name = "NAME", num_args = 1.., value_parser = figure())]
    figure: Vec<Figure>,
    /// In which form
    #[arg(long, value_enum, default_value = "svg")]
    format: Format,
    /// Overwrite existing files
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    window: WindowArgs,
}

/// Form of a figure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Lines and letters, for a text or a browser
    Svg,
    /// Pixels, 144 to the inch
    Png,
}

impl Format {
    fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Png => "png",
        }
    }
}

/// Takes a figure by its name.
fn figure() -> impl TypedValueParser<Value = Figure> {
    let names = Figure::ALL.iter().map(|figure| {
        let facts = figure.facts();
        PossibleValue::new(facts.key).help(facts.description.trim_end_matches('.'))
    });
    PossibleValuesParser::new(names).map(|name| {
        // It is one of the possible values.
        Figure::from_key(&name).unwrap_or(Figure::Trajectory)
    })
}

/// Reflies the log, and draws it.
pub fn run(args: &Args) -> Result<Status> {
    let logs: Vec<&Path> =
        [Some(&args.log), args.against.as_ref()].into_iter().flatten().map(|log| &**log).collect();
    if args.against.is_some() && !args.window.is_whole() {
        bail!("--against draws whole flights; `tiltrotor log clip` makes logs of their parts");
    }
    let wanted = if args.figure.is_empty() { Figure::ALL.to_vec() } else { args.figure.clone() };
    let beside = args.log.parent().map_or_else(PathBuf::new, Path::to_path_buf);
    let folder = args.out.as_ref().unwrap_or(&beside);
    let place = |figure: Figure| folder.join(file_name(&logs, figure, args.format.extension()));
    for figure in &wanted {
        output::refuse(&place(*figure), args.force, &logs)?;
    }
    let window = args.window.of(&args.log)?;
    let flown = logs.iter().map(|log| Afterwards::of(log, &window)).collect::<Result<Vec<_>>>()?;
    let flights: Vec<&Flight> = flown.iter().map(|flown| &flown.flight).collect();
    if !folder.as_os_str().is_empty() {
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot make the folder {}", folder.display()))?;
    }
    let mut drawn = 0;
    for figure in wanted {
        let drawn_as = match args.format {
            Format::Svg => svg(figure, &flights),
            Format::Png => png(figure, &flights),
        };
        let bytes = match drawn_as {
            Ok(bytes) => bytes,
            // Of all figures some may not be there.
            Err(error) if args.figure.is_empty() && error.is::<Undrawn>() => {
                say!("{}: {error:#}", figure.facts().key);
                continue;
            }
            Err(error) => return Err(error.context(args.log.display().to_string())),
        };
        let path = place(figure);
        write(&path, &bytes, args.force, &logs)?;
        say!("{}: {}, {}", path.display(), figure.facts().words, size(bytes.len() as u64));
        drawn += 1;
    }
    if drawn == 0 {
        bail!("{}: nothing in it can be drawn", args.log.display());
    }
    for (log, flown) in logs.iter().zip(&flown) {
        say!("{}: {}", log.display(), flown.judgement);
    }
    Ok(Status::gravest(flown.iter().map(|flown| Status::from(&flown.judgement))))
}

/// A figure as SVG.
pub fn svg(figure: Figure, flights: &[&Flight]) -> Result<Vec<u8>> {
    let page = draw(figure, flights, chart::TOLERANCE)?;
    Ok(chart::svg(&page, figure.facts().key).into_bytes())
}

/// A figure as PNG.
fn png(figure: Figure, flights: &[&Flight]) -> Result<Vec<u8>> {
    let page = draw(figure, flights, chart::TOLERANCE)?;
    Ok(chart::png::png(&page, PIXELS_PER_POINT)?)
}

/// `flight-euler.svg`; of two flights with both names.
pub fn file_name(logs: &[&Path], figure: Figure, extension: &str) -> String {
    let stem = |log: &&Path| log.file_stem().map_or_else(String::new, |s| s.display().to_string());
    let mut names: Vec<String> = logs.iter().map(stem).collect();
    names.push(figure.facts().key.into());
    format!("{}.{extension}", names.join("-"))
}

/// Writes a file that is made of these logs.
pub fn write(path: &Path, bytes: &[u8], force: bool, logs: &[&Path]) -> Result<()> {
    let output = Output::beside(path, force, logs)?;
    output.file()?.write_all(bytes).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(output.finish()?)
}
