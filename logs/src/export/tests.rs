use super::*;

#[test]
fn every_number_that_is_recorded_has_a_column_of_its_own() {
    let state = Layout::of::<crate::records::StateRecord>().unwrap();
    let names: Vec<_> = columns("state", &state).into_iter().map(|column| column.name).collect();
    assert_eq!(names[..2], ["digest", "tick"]);
    assert!(names.contains(&"plant_velocity_mps_x".into()), "{names:?}");
    for layout in [state, Layout::of::<engine::Outputs>().unwrap()] {
        let columns = columns("any", &layout);
        let names: BTreeSet<_> = columns.iter().map(|column| column.name.clone()).collect();
        assert_eq!(names.len(), layout.numbers().len());
        // No name needs quotes.
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        assert!(names.iter().all(|name| name.chars().all(plain)), "{names:?}");
    }
}

#[test]
fn two_paths_in_one_name_stay_two_columns() {
    let layout = Layout::parse("t/A a\nfloat64 a_b\nfloat64 time_s\n===\nMSG: t/A\nfloat64 b\n");
    let columns = columns("t", &layout.unwrap());
    let names: Vec<_> = columns.iter().map(|column| column.name.as_str()).collect();
    // The second keeps its dots, or takes the table's name.
    assert_eq!(names, ["a_b", "t.a_b", "t.time_s"]);
}
