//! Numbers as they are on the wire.

/// How a number is sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// 32 bits, signed.
    Int,
    /// Single precision.
    Float,
    /// Double precision.
    Double,
}

impl Kind {
    /// Its name in protocol files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Int => "int",
            Self::Float => "float",
            Self::Double => "double",
        }
    }

    /// Its bytes.
    pub const fn size(self) -> usize {
        match self {
            Self::Int | Self::Float => 4,
            Self::Double => 8,
        }
    }

    /// Writes a number as this kind; 0 for what is not finite, the nearest end for what does not fit.
    pub(crate) fn write(self, value: f64, bytes: &mut [u8]) {
        // No display shows a −0.
        let value = if value.is_finite() { value + 0.0 } else { 0.0 };
        match self {
            Self::Int => bytes.copy_from_slice(&(value.round() as i32).to_be_bytes()),
            Self::Float => {
                let narrow = value as f32;
                let narrow = if narrow.is_finite() { narrow } else { 0.0 };
                bytes.copy_from_slice(&narrow.to_be_bytes());
            }
            Self::Double => bytes.copy_from_slice(&value.to_be_bytes()),
        }
    }

    /// Reads a number of this kind from as many bytes as it has.
    pub(crate) fn read(self, bytes: &[u8]) -> f64 {
        let narrow = || bytes.try_into().map_or([0; 4], |four: [u8; 4]| four);
        match self {
            Self::Int => f64::from(i32::from_be_bytes(narrow())),
            Self::Float => f64::from(f32::from_be_bytes(narrow())),
            Self::Double => bytes.try_into().map_or(f64::NAN, f64::from_be_bytes),
        }
    }
}
