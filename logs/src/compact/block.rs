//! A stretch of flight without its states.
//!
//! It lists the messages in the file's order, one byte each: what a message is tells where its bytes
//! come from. Device events, worlds and timings are rows of numbers; states and what viewers draw are
//! flown again; anything else stands as it is, as a message of its own before the block.

use std::ops::Range;

use super::columns::{ColumnReader, Rows, put, zigzag};
use crate::LogError;
use crate::channels::{Compacted, compacted};

/// The parts of a block, each with the numbers of its channels of rows and of what is made again: those
/// that stand in every block, and those that were added to the table of channels since.
fn parts() -> [(Range<usize>, Range<usize>); 2] {
    [(0..3, 0..5), (3..count(Compacted::Rows), 5..count(Compacted::Remade))]
}

/// Where a message's bytes come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// The next row of a channel of rows, by its number.
    Row(u8),
    /// The next state, flown again; its digest is kept.
    State,
    /// Of a channel that is made again of the outputs, by its number.
    View(u8),
    /// The state with which the block ends, as it was recorded: the last message before the block.
    Keyframe,
    /// The next message that stands as it was.
    Plain,
    /// Not a message: the writer closed a chunk here.
    ChunkEnd,
}

impl Op {
    fn byte(self) -> u8 {
        match self {
            Self::Row(number) => number,
            Self::State => 8,
            Self::View(number) => 16 + number,
            Self::Keyframe => 32,
            Self::Plain => 33,
            Self::ChunkEnd => 34,
        }
    }

    fn of(byte: u8) -> Option<Self> {
        Some(match byte {
            0..=7 if usize::from(byte) < count(Compacted::Rows) => Self::Row(byte),
            8 => Self::State,
            16..=31 if usize::from(byte - 16) < count(Compacted::Remade) => Self::View(byte - 16),
            32 => Self::Keyframe,
            33 => Self::Plain,
            34 => Self::ChunkEnd,
            _ => return None,
        })
    }
}

fn count(how: Compacted) -> usize {
    compacted(how).count()
}

/// The block.
#[derive(Debug, PartialEq, Eq)]
pub struct Block {
    /// Tick of the state before it.
    pub first_tick: u64,
    /// Its messages in order.
    pub ops: Vec<Op>,
    /// One for each channel of rows.
    pub rows: Vec<Rows>,
    /// Digests of the states that are flown again.
    pub digests: Vec<u64>,
    /// Ticks of what is made again, one list for each such channel.
    pub view_ticks: Vec<Vec<u64>>,
    /// Digests of the outputs that are made again; none in the form that did not keep them.
    pub outputs: Option<Vec<u32>>,
}

impl Block {
    /// An empty one that follows the state of a tick.
    pub fn after(first_tick: u64) -> Self {
        Self {
            first_tick,
            ops: Vec::new(),
            rows: compacted(Compacted::Rows).map(|_| Rows::default()).collect(),
            digests: Vec::new(),
            view_ticks: vec![Vec::new(); count(Compacted::Remade)],
            outputs: Some(Vec::new()),
        }
    }

    /// As bytes.
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        put(&mut bytes, self.first_tick);
        put(&mut bytes, self.ops.len() as u64);
        bytes.extend(self.ops.iter().map(|op| op.byte()));
        for (rows, views) in parts() {
            self.rows[rows.clone()].iter().for_each(|rows| rows.encode(&mut bytes));
            if rows.start == 0 {
                put(&mut bytes, self.digests.len() as u64);
                bytes.extend(self.digests.iter().flat_map(|digest| digest.to_le_bytes()));
            }
            for ticks in &self.view_ticks[views] {
                put(&mut bytes, ticks.len() as u64);
                let mut last = self.first_tick;
                for &tick in ticks {
                    put(&mut bytes, zigzag(tick.wrapping_sub(last)));
                    last = tick;
                }
            }
        }
        if let Some(outputs) = &self.outputs {
            put(&mut bytes, outputs.len() as u64);
            bytes.extend(outputs.iter().flat_map(|digest| digest.to_le_bytes()));
        }
        bytes
    }

    /// From bytes; `with_outputs` says whether digests of the outputs are among them.
    pub fn decode(bytes: &[u8], with_outputs: bool) -> Result<Self, LogError> {
        let mut from = ColumnReader(bytes);
        let first_tick = from.number()?;
        let ops = from
            .sized()?
            .iter()
            .map(|&byte| Op::of(byte).ok_or_else(|| unknown(byte)))
            .collect::<Result<_, _>>()?;
        let mut block = Self { ops, outputs: None, ..Self::after(first_tick) };
        for (rows, views) in parts() {
            let first = rows.start == 0;
            // What was added to the table of channels since the first form.
            if !first && !with_outputs && from.0.is_empty() {
                break;
            }
            for rows in &mut block.rows[rows] {
                *rows = Rows::decode(&mut from)?;
            }
            if first {
                let digests = from.count(8)?;
                let (digests, _) = from.bytes(8 * digests)?.as_chunks::<8>();
                block.digests = digests.iter().map(|digest| u64::from_le_bytes(*digest)).collect();
            }
            for ticks in &mut block.view_ticks[views] {
                let mut last = first_tick;
                for _ in 0..from.count(1)? {
                    last = last.wrapping_add(from.difference()?);
                    ticks.push(last);
                }
            }
        }
        if with_outputs {
            let digests = from.count(4)?;
            let (digests, _) = from.bytes(4 * digests)?.as_chunks::<4>();
            let digests = digests.iter().map(|digest| u32::from_le_bytes(*digest));
            block.outputs = Some(digests.collect());
        }
        if from.0.is_empty() { Ok(block) } else { Err(LogError::Decode("a block too long".into())) }
    }
}

fn unknown(byte: u8) -> LogError {
    LogError::Decode(format!("a block with a message of the unknown kind {byte}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_comes_back_and_a_cut_one_does_not() {
        let mut block = Block::after(1000);
        let ops = [Op::Row(0), Op::Row(1), Op::State, Op::Row(2), Op::View(4), Op::Plain];
        block.ops.extend(ops.into_iter().chain([Op::ChunkEnd, Op::Keyframe]));
        assert!(block.rows[0].push(&[7; 48]) && block.rows[1].push(&[1; 16]));
        block.digests = vec![u64::MAX, 3];
        block.view_ticks[4] = vec![995, 1005, 1000];
        for outputs in [Some(vec![7, u32::MAX]), None] {
            block.outputs = outputs;
            let with_outputs = block.outputs.is_some();
            let bytes = block.encode();
            assert_eq!(Block::decode(&bytes, with_outputs).unwrap(), block);
            for cut in 0..bytes.len() {
                assert!(Block::decode(&bytes[..cut], with_outputs).is_err(), "cut at {cut}");
            }
            let mut longer = bytes.clone();
            longer.push(0);
            assert!(Block::decode(&longer, with_outputs).is_err());
        }
    }
}
