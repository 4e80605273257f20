//! A table as Parquet: row groups of constant size, so that memory does not grow with the flight.

use std::fs::File;
use std::io::BufWriter;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{ColumnPath, Type};

use super::table::{Cell, Column, ColumnKind, Table};
use crate::LogError;
use crate::fields::Value;
use crate::layout::Kind;

/// Bytes of a row group's numbers before encoding.
const GROUP_BYTES: usize = 16 << 20;
/// Rows of a group at most: a reader takes one at a time.
const GROUP_ROWS: usize = 1 << 17;
/// A column with more different values than fit here is no dictionary's.
const DICTIONARY_BYTES: usize = 8 << 10;

pub(super) struct ParquetTable {
    file: SerializedFileWriter<BufWriter<File>>,
    columns: Vec<Values>,
    rows: usize,
    rows_max: usize,
}

/// A column of the row group under way.
enum Values {
    F64(Vec<f64>),
    I64(Vec<i64>),
    Text(Vec<ByteArray>),
}

impl ParquetTable {
    pub fn new(file: File, columns: &[Column]) -> Result<Self, LogError> {
        let fields = columns.iter().map(field).collect::<Result<_, _>>().map_err(told)?;
        let schema =
            Type::group_type_builder("flight").with_fields(fields).build().map_err(told)?;
        let mut properties = WriterProperties::builder()
            .set_created_by(concat!("tiltrotor ", env!("CARGO_PKG_VERSION")).into())
            .set_compression(Compression::ZSTD(ZstdLevel::try_new(3).map_err(told)?))
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_dictionary_page_size_limit(DICTIONARY_BYTES);
        for column in columns {
            // What these encodings are for: numbers that change little by little.
            let encoding = match column.kind {
                ColumnKind::Number(Kind::F64) => Encoding::BYTE_STREAM_SPLIT,
                ColumnKind::Number(Kind::U64 | Kind::I64) => Encoding::DELTA_BINARY_PACKED,
                ColumnKind::Text => Encoding::PLAIN,
            };
            let path = ColumnPath::new(vec![column.name.clone()]);
            properties = properties.set_column_encoding(path, encoding);
        }
        let file = BufWriter::with_capacity(256 * 1024, file);
        let file = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties.build()))
            .map_err(told)?;
        let values = |column: &Column| match column.kind {
            ColumnKind::Number(Kind::F64) => Values::F64(Vec::new()),
            ColumnKind::Number(Kind::U64 | Kind::I64) => Values::I64(Vec::new()),
            ColumnKind::Text => Values::Text(Vec::new()),
        };
        Ok(Self {
            file,
            columns: columns.iter().map(values).collect(),
            rows: 0,
            rows_max: GROUP_ROWS.min(GROUP_BYTES / (8 * columns.len().max(1))).max(1),
        })
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.file.next_row_group()?;
        for values in &mut self.columns {
            let Some(mut column) = group.next_column()? else { break };
            match (values, column.untyped()) {
                (Values::F64(values), ColumnWriter::DoubleColumnWriter(column)) => {
                    column.write_batch(values, None, None)?;
                    values.clear();
                }
                (Values::I64(values), ColumnWriter::Int64ColumnWriter(column)) => {
                    column.write_batch(values, None, None)?;
                    values.clear();
                }
                (Values::Text(values), ColumnWriter::ByteArrayColumnWriter(column)) => {
                    column.write_batch(values, None, None)?;
                    values.clear();
                }
                _ => return Err(ParquetError::General("a column of another type".into())),
            }
            column.close()?;
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }
}

impl Table for ParquetTable {
    fn push(&mut self, row: &[Cell]) -> Result<(), LogError> {
        for (values, cell) in self.columns.iter_mut().zip(row) {
            match (values, cell) {
                (Values::F64(values), Cell::Number(Value::F64(number))) => values.push(*number),
                (Values::I64(values), Cell::Number(Value::U64(number))) => {
                    values.push(number.cast_signed());
                }
                (Values::I64(values), Cell::Number(Value::I64(number))) => values.push(*number),
                (Values::Text(values), Cell::Text(text)) => values.push(text.as_ref().into()),
                _ => return Err(LogError::Encode("a cell of another type than its column".into())),
            }
        }
        self.rows += 1;
        if self.rows >= self.rows_max { self.write_group().map_err(told) } else { Ok(()) }
    }

    fn finish(mut self: Box<Self>) -> Result<(), LogError> {
        if self.rows > 0 {
            self.write_group().map_err(told)?;
        }
        let file = self.file.into_inner().map_err(told)?;
        let file = file.into_inner().map_err(std::io::IntoInnerError::into_error)?;
        Ok(file.sync_all()?)
    }
}

fn field(column: &Column) -> Result<Arc<Type>, ParquetError> {
    let integer = |is_signed| Some(LogicalType::integer(64, is_signed));
    let (physical, logical) = match column.kind {
        ColumnKind::Number(Kind::F64) => (Physical::DOUBLE, None),
        ColumnKind::Number(Kind::U64) => (Physical::INT64, integer(false)),
        ColumnKind::Number(Kind::I64) => (Physical::INT64, integer(true)),
        ColumnKind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
    };
    let field = Type::primitive_type_builder(&column.name, physical)
        .with_repetition(Repetition::REQUIRED)
        .with_logical_type(logical);
    Ok(Arc::new(field.build()?))
}

fn told(error: ParquetError) -> LogError {
    match error {
        // A full disk is to be called one.
        ParquetError::External(error) => match error.downcast::<std::io::Error>() {
            Ok(error) => LogError::Io(*error),
            Err(error) => LogError::Encode(error.to_string()),
        },
        error => LogError::Encode(error.to_string()),
    }
}
