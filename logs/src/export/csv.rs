//! A table as comma-separated text.

use std::fs::File;
use std::io::Write;

use super::table::{Cell, Column, Table};
use crate::LogError;

pub(super) struct CsvTable {
    csv: csv::Writer<File>,
    cell: Vec<u8>,
}

impl CsvTable {
    pub fn new(file: File, columns: &[Column]) -> Result<Self, LogError> {
        let mut csv = csv::WriterBuilder::new().buffer_capacity(64 * 1024).from_writer(file);
        csv.write_record(columns.iter().map(|column| &column.name)).map_err(told)?;
        Ok(Self { csv, cell: Vec::new() })
    }
}

impl Table for CsvTable {
    fn push(&mut self, row: &[Cell]) -> Result<(), LogError> {
        for cell in row {
            match cell {
                Cell::Text(text) => self.csv.write_field(text.as_bytes()),
                Cell::Number(number) => {
                    self.cell.clear();
                    write!(self.cell, "{number}")?;
                    self.csv.write_field(&self.cell)
                }
            }
            .map_err(told)?;
        }
        self.csv.write_record(None::<&[u8]>).map_err(told)
    }

    fn finish(mut self: Box<Self>) -> Result<(), LogError> {
        self.csv.flush()?;
        Ok(self.csv.get_ref().sync_all()?)
    }
}

fn told(error: csv::Error) -> LogError {
    let words = error.to_string();
    match error.into_kind() {
        csv::ErrorKind::Io(error) => LogError::Io(error),
        _ => LogError::Encode(words),
    }
}
