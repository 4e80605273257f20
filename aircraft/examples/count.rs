#[path = "rotor_lab.rs"] #[allow(dead_code)] mod lab;
use engine::rotors::*;
fn main() { let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap(); let p=&x.rotors;
    let i=lab::inputs(589.0, 10.0/57.3); let mut s=State::default();
    for _ in 0..2000 { s=std::hint::black_box(rotor(p,&p.blade(),std::hint::black_box(&s),&i)).0; } println!("{:?}", s.inflow); }
