//! The records of a block, one after the other, each made again from how it is kept.

use std::collections::VecDeque;

use super::{Expander, tick_of};
use crate::channels::{Channel, ChannelId, Compacted as How, compacted};
use crate::compact::block::Op;
use crate::compact::files::broken;
use crate::compact::regenerator::short_digest;
use crate::container::{Record, stamped};
use crate::records::{RESTART, STATE, StateRecord};
use crate::{LogError, cdr};

impl Expander {
    /// The next record of the block; `false` when it has no more.
    pub(super) fn next_of_block(&mut self, record: &mut Record) -> Result<bool, LogError> {
        while let Some(at) = &mut self.block {
            let Some(op) = at.block.ops.get(at.next).copied() else {
                self.block = None;
                break;
            };
            at.next += 1;
            match op {
                Op::ChunkEnd => *record = Record::ChunkEnd,
                Op::Plain => self.plain(record)?,
                Op::Row(number) => self.row(usize::from(number), record)?,
                Op::State => self.state(record)?,
                Op::Keyframe => self.end_of_block(record)?,
                Op::View(number) => {
                    if !self.view(usize::from(number), record)? {
                        continue;
                    }
                }
            }
            return Ok(true);
        }
        Ok(false)
    }

    fn plain(&mut self, record: &mut Record) -> Result<(), LogError> {
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let (header, data) = at.plain.pop_front().ok_or_else(|| broken("a message less"))?;
        if self.definitions.is(STATE, header.channel_id) {
            // It is flown on from there.
            (at.flown, at.ticks) = (None, VecDeque::new());
            self.stand_at(&data)?;
            self.states += 1;
            self.reflown = false;
        } else if self.definitions.is(RESTART, header.channel_id)
            && let Some(regenerator) = &mut self.regenerator
        {
            regenerator.takes(ChannelId::Restart, &data)?;
        }
        *record = Record::Message(header, data);
        Ok(())
    }

    fn row(&mut self, number: usize, record: &mut Record) -> Result<(), LogError> {
        let channel = numbered(How::Rows, number)?;
        let id = self.definitions.id(channel.topic)?;
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let row = at.block.rows[number].row(at.row[number]).ok_or_else(|| broken("a row less"))?;
        at.row[number] += 1;
        let data = record.message(stamped(id, row[0]));
        data.extend_from_slice(&cdr::HEADER);
        data.extend(row.iter().flat_map(|word| word.to_le_bytes()));
        self.regenerator.as_mut().map_or(Ok(()), |regenerator| regenerator.takes(channel.id, data))
    }

    fn state(&mut self, record: &mut Record) -> Result<(), LogError> {
        let id = self.definitions.id(STATE)?;
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let digest = at.block.digests.get(at.digest).ok_or_else(|| broken("a digest less"))?;
        let digest = *digest;
        at.digest += 1;
        self.states += 1;
        self.tick = self.tick.wrapping_add(1);
        self.reflown = true;
        self.fly()?;
        if let Some(regenerator) = &mut self.regenerator {
            self.tick = regenerator.state.tick;
            return regenerator.state_message(record.message(stamped(id, self.tick)), digest);
        }
        let data = record.message(stamped(id, self.tick));
        data.extend_from_slice(&self.keyframe);
        for (place, number) in [(0, digest), (StateRecord::TICK, self.tick)] {
            let at = cdr::HEADER.len() + 8 * place;
            let word = data.get_mut(at..at + 8).ok_or_else(|| broken("no keyframe"))?;
            word.copy_from_slice(&number.to_le_bytes());
        }
        Ok(())
    }

    fn end_of_block(&mut self, record: &mut Record) -> Result<(), LogError> {
        let keyframe = self.block.as_mut().and_then(|at| at.keyframe.take());
        let (header, data) = keyframe.ok_or_else(|| broken("a keyframe less"))?;
        self.fly()?;
        if let Some(regenerator) = &mut self.regenerator {
            // The same, or the log does not refly: then what was recorded counts.
            regenerator.state = cdr::decode::<StateRecord>(&data)?.state;
        }
        self.states += 1;
        self.tick = tick_of(&data)?;
        self.reflown = false;
        self.keyframe.clone_from(&data);
        *record = Record::Message(header, data);
        Ok(())
    }

    /// `false` when nothing is flown again, or reading began after that tick.
    fn view(&mut self, number: usize, record: &mut Record) -> Result<bool, LogError> {
        let channel = numbered(How::Remade, number)?;
        let id = self.definitions.id(channel.topic)?;
        let at = self.block.as_mut().ok_or_else(|| broken("no block"))?;
        let tick = at.block.view_ticks[number].get(at.view[number]).copied();
        let tick = tick.ok_or_else(|| broken("a tick less"))?;
        let kept = at.block.outputs.as_ref().filter(|_| channel.id == ChannelId::Outputs);
        let digest = match kept {
            Some(digests) => {
                Some(*digests.get(at.view[number]).ok_or_else(|| broken("a digest less"))?)
            }
            None => None,
        };
        at.view[number] += 1;
        let Some(regenerator) = &self.regenerator else { return Ok(false) };
        let message = record.message(stamped(id, tick));
        if regenerator.view(message, channel, tick)? {
            if digest.is_some_and(|digest| digest != short_digest(message)) {
                self.outputs_differ.get_or_insert(tick);
            }
            return Ok(true);
        }
        if self.sought && tick <= regenerator.begun_tick {
            return Ok(false);
        }
        Err(broken("viewers' messages of a tick that is long past"))
    }
}

/// The channel of that number among those that are compacted alike.
fn numbered(how: How, number: usize) -> Result<&'static Channel, LogError> {
    compacted(how).nth(number).ok_or_else(|| broken("a channel is not there"))
}
