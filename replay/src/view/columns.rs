//! Rows as rerun takes them.

use engine::frames::Vec3;
use rerun::SerializedComponentColumn;

/// What to send of some rows.
pub type Columns = rerun::SerializationResult<Vec<SerializedComponentColumn>>;

/// As rerun takes it.
pub fn point<F>(v: Vec3<F>) -> [f32; 3] {
    [v.x as f32, v.y as f32, v.z as f32]
}
