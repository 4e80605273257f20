//! Numbers as few bytes: rows of eight-byte numbers, column by column, as differences.

use crate::LogError;

/// Appends bytes of variable length, seven bits each, the lowest first.
pub fn put(bytes: &mut Vec<u8>, mut number: u64) {
    while number >= 0x80 {
        bytes.push(number as u8 | 0x80);
        number >>= 7;
    }
    bytes.push(number as u8);
}

/// A small number for a small difference, whichever way it goes.
pub fn zigzag(difference: u64) -> u64 {
    let signed = difference.cast_signed();
    (signed.wrapping_shl(1) ^ (signed >> 63)).cast_unsigned()
}

fn unzigzag(number: u64) -> u64 {
    (number >> 1) ^ (number & 1).wrapping_neg()
}

/// Takes from the front of a block's bytes.
pub struct ColumnReader<'a>(pub &'a [u8]);

impl<'a> ColumnReader<'a> {
    /// A number.
    pub fn number(&mut self) -> Result<u64, LogError> {
        let mut number = 0;
        for shift in (0..64).step_by(7) {
            let (&byte, rest) = self.0.split_first().ok_or_else(short)?;
            self.0 = rest;
            number |= u64::from(byte & 0x7f) << shift;
            if byte & 0x80 == 0 {
                return Ok(number);
            }
        }
        Err(LogError::Decode("a block with a number of more than 64 bits".into()))
    }

    /// How many of something that takes at least `bytes_each`: no more than there can be.
    pub fn count(&mut self, bytes_each: usize) -> Result<usize, LogError> {
        let count = self.number()?;
        usize::try_from(count)
            .ok()
            .filter(|count| count.checked_mul(bytes_each).is_some_and(|all| all <= self.0.len()))
            .ok_or_else(short)
    }

    /// A difference.
    pub fn difference(&mut self) -> Result<u64, LogError> {
        Ok(unzigzag(self.number()?))
    }

    /// So many bytes.
    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8], LogError> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or_else(short)?;
        self.0 = rest;
        Ok(taken)
    }

    /// Text or bytes with their length before them.
    pub fn sized(&mut self) -> Result<&'a [u8], LogError> {
        let count = self.count(1)?;
        self.bytes(count)
    }
}

fn short() -> LogError {
    LogError::Decode("a block that ends too early".into())
}

/// Rows of equal width.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Rows {
    width: usize,
    words: Vec<u64>,
}

impl Rows {
    /// Adds the body of a message; `false` when it has another width than the rows before, or is
    /// not made of eight-byte numbers.
    pub fn push(&mut self, body: &[u8]) -> bool {
        let (words, rest) = body.as_chunks::<8>();
        let fits = self.words.is_empty() || self.width == words.len();
        if !rest.is_empty() || words.is_empty() || !fits {
            return false;
        }
        self.width = words.len();
        self.words.extend(words.iter().map(|word| u64::from_le_bytes(*word)));
        true
    }

    /// The row of that number.
    pub fn row(&self, number: usize) -> Option<&[u64]> {
        let start = number.checked_mul(self.width)?;
        self.words.get(start..start.checked_add(self.width)?).filter(|row| !row.is_empty())
    }

    /// Appends them.
    pub fn encode(&self, bytes: &mut Vec<u8>) {
        put(bytes, self.width as u64);
        put(bytes, (self.words.len() / self.width.max(1)) as u64);
        for column in 0..self.width {
            let numbers = || self.words.iter().skip(column).step_by(self.width).copied();
            // Clocks go on evenly: there the differences of differences are the small ones.
            let orders = [1, 2].map(|order| {
                let mut column = vec![order];
                let (mut last, mut last_step) = (0_u64, 0_u64);
                for number in numbers() {
                    let step = number.wrapping_sub(last);
                    let small = if order == 1 { step } else { step.wrapping_sub(last_step) };
                    put(&mut column, zigzag(small));
                    (last, last_step) = (number, step);
                }
                column
            });
            let [first, second] = orders;
            bytes.extend(if second.len() < first.len() { second } else { first });
        }
    }

    /// Takes them.
    pub fn decode(from: &mut ColumnReader<'_>) -> Result<Self, LogError> {
        let width = from.count(0)?;
        let count = from.count(width)?;
        // Every number takes a byte, at least.
        let all = count.checked_mul(width).filter(|&all| all <= from.0.len()).ok_or_else(short)?;
        let mut words = vec![0; all];
        if count == 0 {
            return Ok(Self { width: 0, words });
        }
        for column in 0..width {
            let order = from.number()?;
            let (mut last, mut last_step) = (0_u64, 0_u64);
            for word in words.iter_mut().skip(column).step_by(width) {
                let small = from.difference()?;
                let step = if order == 1 { small } else { small.wrapping_add(last_step) };
                *word = last.wrapping_add(step);
                (last, last_step) = (*word, step);
            }
        }
        Ok(Self { width, words })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_come_back_to_the_bit() {
        let mut rows = Rows::default();
        let numbers = [
            [0, u64::MAX, f64::to_bits(-0.0), 4_000_000],
            [1, 0, f64::to_bits(f64::NAN), 8_000_001],
            [2, 7, f64::to_bits(1.5), 11_999_999],
        ];
        for row in numbers {
            let body: Vec<u8> = row.iter().flat_map(|word| word.to_le_bytes()).collect();
            assert!(rows.push(&body));
        }
        assert!(!rows.push(&[0; 8]), "another width");
        assert!(!rows.push(&[0; 31]), "not of eight bytes");
        let mut bytes = Vec::new();
        rows.encode(&mut bytes);
        let mut taker = ColumnReader(&bytes);
        let back = Rows::decode(&mut taker).unwrap();
        assert_eq!(back, rows);
        assert_eq!(back.row(2), Some(&numbers[2][..]));
        assert_eq!(back.row(3), None);
        assert!(taker.0.is_empty());
        for cut in 0..bytes.len() {
            assert!(Rows::decode(&mut ColumnReader(&bytes[..cut])).is_err(), "cut at {cut}");
        }
    }

    #[test]
    fn a_count_beyond_the_bytes_is_refused_before_memory_is_asked_for() {
        let mut bytes = Vec::new();
        put(&mut bytes, 1 << 20);
        put(&mut bytes, 1 << 40);
        assert!(Rows::decode(&mut ColumnReader(&bytes)).is_err());
    }
}
