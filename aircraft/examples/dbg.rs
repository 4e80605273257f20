#[path = "rotor_lab.rs"] #[allow(dead_code)] mod lab;
fn main() {
    let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap();
    for c in std::env::args().skip(1) { let i = lab::inputs(586.7, c.parse::<f64>().unwrap()/57.29578);
    let (_s,_o)=lab::settle(&x.rotors,&i); eprintln!("---- {c}"); engine::rotors::rotor(&x.rotors,&x.rotors.blade(),&_s,&i); }
}
