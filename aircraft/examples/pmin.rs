#[path = "rotor_lab.rs"] #[allow(dead_code)] mod lab;
fn main() { let x = aircraft::aircraft("xv15.toml", aircraft::XV15).unwrap(); let p=&x.rotors;
    for c in -8..20 { let mut i=lab::inputs(589.0, c as f64/57.29578); i.hub_height_m=3.9; let (s,o)=lab::settle(p,&i); println!("{c}: T {:.0} P2 {:.0} kW  v {:.2} cone {:.2}", o.thrust_n, o.power_w*2e-3, s.inflow.mean_mps, o.coning_rad*57.3); } }
