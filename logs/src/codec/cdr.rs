//! Bytes of a message: ROS 2 CDR, little-endian.
//!
//! A recorded struct is eight-byte numbers only, so that its plain `bincode` encoding *is* its CDR
//! encoding: one copy of the bytes serves the bit-exact replay and every viewer. View messages with
//! strings and lists take the general encoder.

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::LogError;

/// What MCAP calls it.
pub(crate) const ENCODING: &str = "cdr";

/// CDR version 1, little-endian.
pub const HEADER: [u8; 4] = [0, 1, 0, 0];

const FIXED: bincode::config::Configuration<
    bincode::config::LittleEndian,
    bincode::config::Fixint,
> = bincode::config::legacy();

/// A recorded struct as a message.
///
/// # Errors
/// When it holds something without a fixed size.
pub fn encode<T: Serialize>(value: &T) -> Result<Vec<u8>, LogError> {
    let mut bytes = Vec::new();
    append(&mut bytes, value)?;
    Ok(bytes)
}

/// Appends a recorded struct as a message, reusing the buffer's room.
///
/// # Errors
/// As for [`encode`].
pub fn append<T: Serialize>(bytes: &mut Vec<u8>, value: &T) -> Result<(), LogError> {
    bytes.extend_from_slice(&HEADER);
    bincode::serde::encode_into_std_write(value, bytes, FIXED)
        .map_err(|error| LogError::Encode(error.to_string()))?;
    Ok(())
}

/// A message as a recorded struct.
///
/// # Errors
/// When the bytes are too few, too many, or not little-endian CDR.
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, LogError> {
    let body = body_of(bytes)?;
    let (value, used) = bincode::serde::decode_from_slice(body, FIXED)
        .map_err(|_| LogError::Decode(format!("too short, with {} bytes", bytes.len())))?;
    if used == body.len() {
        Ok(value)
    } else {
        Err(LogError::Decode(format!("expected {used} bytes, got {}", body.len())))
    }
}

/// The number at that place of a recorded struct's message.
pub(crate) fn word(message: &[u8], place: usize) -> Option<u64> {
    let start = HEADER.len() + size_of::<u64>() * place;
    message.get(start..)?.first_chunk::<8>().map(|word| u64::from_le_bytes(*word))
}

/// A view message: any serde struct, with strings and lists.
///
/// # Errors
/// When it holds something CDR has no form for.
pub fn encode_view<T: Serialize>(value: &T) -> Result<Vec<u8>, LogError> {
    let mut bytes = Vec::new();
    append_view(&mut bytes, value)?;
    Ok(bytes)
}

/// Appends a view message.
///
/// # Errors
/// As for [`encode_view`].
pub fn append_view<T: Serialize>(bytes: &mut Vec<u8>, value: &T) -> Result<(), LogError> {
    bytes.extend_from_slice(&HEADER);
    let body = cdr_encoding::to_vec::<T, byteorder::LittleEndian>(value)
        .map_err(|error| LogError::Encode(error.to_string()))?;
    bytes.extend_from_slice(&body);
    Ok(())
}

/// A view message read back, from its beginning.
pub(crate) fn decode_view<T: DeserializeOwned>(bytes: &[u8], what: &str) -> Result<T, LogError> {
    cdr_encoding::from_bytes::<T, byteorder::LittleEndian>(body_of(bytes)?)
        .map(|(value, _)| value)
        .map_err(|_| LogError::Decode(format!("not {what}")))
}

/// A message without its header.
pub(crate) fn body_of(bytes: &[u8]) -> Result<&[u8], LogError> {
    bytes
        .strip_prefix(&HEADER)
        .ok_or_else(|| LogError::Decode("not a little-endian CDR message".into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_encoded_is_decoded_to_the_same_bits() {
        let mut state = engine::State { tick: 7, ..engine::State::default() };
        state.plant.fuel_kg = -0.0;
        let bytes = encode(&state).unwrap();
        let back: engine::State = decode(&bytes).unwrap();
        assert_eq!(encode(&back).unwrap(), bytes);
        assert!(decode::<engine::State>(&bytes[..bytes.len() - 1]).is_err());
        assert!(decode::<engine::inputs::DeviceEvent>(&bytes).is_err());
    }

    #[test]
    fn the_general_encoder_gives_the_same_bytes_for_a_recorded_struct() {
        let event = engine::inputs::DeviceEvent { value: -5, code: 3, ..Default::default() };
        assert_eq!(encode(&event).unwrap(), encode_view(&event).unwrap());
    }
}
