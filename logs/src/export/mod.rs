//! Flights as tables, for whoever asks many of them at once: CSV, or Parquet with the feature of that
//! name.
//!
//! One folder a channel, in it one file a flight: `state/flight=hover-1c0ffee5/data.parquet`. That is
//! how DuckDB, Polars, Spark and Trino expect a table in parts, with `flight` as a column of it. The
//! table `flights` has a row a flight, with everything the log says of itself.
//!
//! A log is exported by its own schema, whatever version wrote it: what it lacks is a column that its
//! file does not have, and readers that unite files by name fill it with nulls.

mod csv;
mod flights;
#[cfg(feature = "parquet")]
mod parquet;
mod table;

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use crate::channels::ChannelId;
use crate::compact::FlightModelOf;
use crate::fields::Value;
use crate::layout::{Kind, Layout};
use crate::output::{self, hidden};
use crate::records::STATE;
use crate::view;
use crate::{Ending, LogError, Message, Messages, OpenOptions};

pub use flights::Judged;

use flights::Flight;
use table::{Cell, Column, Table};

/// What the tables are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Comma-separated text; numbers in as many digits as give the same bits back.
    Csv,
    /// Parquet: typed, compressed, in row groups.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Form {
    fn file_name(self) -> &'static str {
        match self {
            Self::Csv => "data.csv",
            #[cfg(feature = "parquet")]
            Self::Parquet => "data.parquet",
        }
    }

    fn begin(self, file: File, columns: &[Column]) -> Result<Box<dyn Table>, LogError> {
        Ok(match self {
            Self::Csv => Box::new(csv::CsvTable::new(file, columns)?),
            #[cfg(feature = "parquet")]
            Self::Parquet => Box::new(parquet::ParquetTable::new(file, columns)?),
        })
    }
}

/// What became of a log.
#[derive(Clone, Debug)]
pub struct Exported {
    /// Name of the flight in the tables: that of the file, and eight digits of what was flown and when.
    pub flight: String,
    /// Tables with their numbers of rows; empty when the flight had been exported before.
    pub rows: BTreeMap<String, u64>,
    /// Size of the files.
    pub bytes: u64,
    /// How the log ends: what comes before is in the tables.
    pub ending: Ending,
}

/// Exports a log into the tables below `folder`. A flight that is there already is left alone, unless
/// `force` is set. `progress` is told the time of each message, ns since the start of the flight.
///
/// # Errors
/// When the log is not a flight, its messages are not what their schema says, or a file cannot be
/// written. Of such a log nothing is left in the tables.
pub fn export(
    log: &Path,
    folder: &Path,
    form: Form,
    force: bool,
    judged: Judged,
    aircraft_of: FlightModelOf,
    mut progress: impl FnMut(u64),
) -> Result<Exported, LogError> {
    let options = OpenOptions { aircraft_of: Some(aircraft_of), across_versions: false };
    let mut messages = Messages::open(log, options)?;
    let mut flight = Flight::new(log);
    let mut tables = Tables::new(folder, form)?;
    let mut known = None;
    while messages.next_message().is_some() {
        let message = &messages.message;
        if message.topic() == STATE && known.is_none() {
            let name = flight.name(messages.facts(), messages.files(), &message.data)?;
            if !force && tables.place("flights", &name).exists() {
                let (rows, ending) = (BTreeMap::new(), Ending::Closed);
                return Ok(Exported { flight: name, rows, bytes: 0, ending });
            }
            known = Some(name);
        }
        flight.saw(message)?;
        tables.add(message)?;
        progress(message.time_ns);
    }
    let ending = messages.ending();
    let Some(name) = known else {
        return Err(match ending {
            Ending::Damaged(why) => LogError::NotAFlight(why),
            _ => LogError::NotAFlight("it has no /state".into()),
        });
    };
    tables.add_flight(flight.row(&messages, &ending, judged))?;
    let (rows, bytes) = tables.finish(&name)?;
    Ok(Exported { flight: name, rows, bytes, ending })
}

/// The tables of one flight, in a folder of their own until they are whole.
struct Tables {
    folder: PathBuf,
    unfinished: PathBuf,
    /// Says to others that it is being written.
    _lock: File,
    form: Form,
    open: BTreeMap<String, OpenTable>,
}

struct OpenTable {
    table: Box<dyn Table>,
    /// Of the messages; `None` where the columns are not a message's.
    layout: Option<Layout>,
    rows: u64,
}

impl Drop for Tables {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.unfinished);
    }
}

impl Tables {
    fn new(folder: &Path, form: Form) -> Result<Self, LogError> {
        let failed = |error| LogError::create(folder, error);
        fs::create_dir_all(folder).map_err(failed)?;
        let (unfinished, lock) = hidden::folder_in(folder).map_err(failed)?;
        Ok(Self { folder: folder.into(), unfinished, _lock: lock, form, open: BTreeMap::new() })
    }

    /// Where a flight's part of a table belongs.
    fn place(&self, table: &str, flight: &str) -> PathBuf {
        self.folder.join(table).join(format!("flight={flight}")).join(self.form.file_name())
    }

    fn open(
        &mut self,
        name: &str,
        columns: &[Column],
        layout: Option<&Layout>,
    ) -> Result<&mut OpenTable, LogError> {
        let path = self.unfinished.join(name);
        let file = File::create_new(&path).map_err(|error| LogError::create(&path, error))?;
        let table = self.form.begin(file, columns)?;
        let open = OpenTable { table, layout: layout.cloned(), rows: 0 };
        Ok(self.open.entry(name.to_string()).or_insert(open))
    }

    fn add(&mut self, message: &Message) -> Result<(), LogError> {
        let time = [
            Cell::Number(Value::U64(message.time_ns)),
            Cell::Number(Value::F64(message.time_ns as f64 * 1e-9)),
        ];
        if message.channel().is_some_and(|channel| channel.id == ChannelId::Log) {
            let line = view::log_line(&message.data)?;
            let level = Cell::Number(Value::U64(line.level as u64));
            let columns = [Column::number("level", Kind::U64), Column::text("words")];
            let open = match self.open.get_mut("log") {
                Some(open) => open,
                None => self.open("log", &with_time(&columns), None)?,
            };
            open.rows += 1;
            let [ns, s] = time;
            return open.table.push(&[ns, s, level, Cell::Text(line.words.into())]);
        }
        let Some(layout) = message.layout() else { return Ok(()) };
        let name = message.topic().trim_start_matches('/').replace('/', "_");
        let open = match self.open.get_mut(&name) {
            Some(open) => open,
            None => self.open(&name, &with_time(&columns(&name, layout)), Some(layout))?,
        };
        if open.layout.as_ref() != Some(layout) {
            let topic = message.topic();
            return Err(LogError::Order(format!("{topic} changes its layout on the way")));
        }
        let mut row = Vec::with_capacity(layout.numbers().len() + time.len());
        row.extend(time);
        let numbers = layout.numbers().iter().zip(layout.bits(&message.data)?);
        row.extend(numbers.map(|(number, bits)| Cell::Number(number.kind.value(bits))));
        open.rows += 1;
        open.table.push(&row)
    }

    /// The flight's row in the table of flights.
    fn add_flight(&mut self, row: Vec<(Column, Cell)>) -> Result<(), LogError> {
        let (columns, cells): (Vec<_>, Vec<_>) = row.into_iter().unzip();
        let open = self.open("flights", &columns, None)?;
        open.rows += 1;
        open.table.push(&cells)
    }

    /// Ends the files and puts them where they belong, the row of the flight last: a flight that has
    /// one is whole.
    fn finish(mut self, flight: &str) -> Result<(BTreeMap<String, u64>, u64), LogError> {
        let mut rows = BTreeMap::new();
        let mut bytes = 0;
        for (name, open) in std::mem::take(&mut self.open) {
            open.table.finish()?;
            rows.insert(name, open.rows);
        }
        let last = |name: &&String| name.as_str() == "flights";
        let order = rows.keys().filter(|name| !last(name)).chain(rows.keys().filter(last));
        for name in order {
            let place = self.place(name, flight);
            if let Some(parent) = place.parent() {
                fs::create_dir_all(parent).map_err(|error| LogError::create(parent, error))?;
            }
            output::place(&self.unfinished.join(name), &place, &place, true)?;
            bytes += fs::metadata(&place)?.len();
        }
        Ok((rows, bytes))
    }
}

fn with_time(columns: &[Column]) -> Vec<Column> {
    let time = [Column::number("time_ns", Kind::U64), Column::number("time_s", Kind::F64)];
    time.into_iter().chain(columns.iter().cloned()).collect()
}

/// The columns of a channel. A path becomes a name that needs no quotes in SQL, and the part that is
/// called as the table is left out: `state.plant.position_m.x` is `plant_position_m_x` in `state`.
fn columns(table: &str, layout: &Layout) -> Vec<Column> {
    let prefix = format!("{table}.");
    let mut taken: BTreeSet<String> = ["time_ns", "time_s", "flight"].map(String::from).into();
    let column = |number: &crate::layout::Number| {
        let path = number.path.strip_prefix(&prefix).unwrap_or(&number.path);
        let name = path.replace(['.', '['], "_").replace(']', "").to_ascii_lowercase();
        // Two paths in one name: the second says its table, quotes or not. Within a message no path
        // is there twice.
        let name = if taken.insert(name.clone()) { name } else { format!("{prefix}{path}") };
        Column::number(name, number.kind)
    };
    layout.numbers().iter().map(column).collect()
}

#[cfg(test)]
mod tests;
