//! The sources that module pages and the aircraft file name by a key.
//!
//! - **CR536**: Ferguson, *A Mathematical Model for Real Time Flight Simulation of a Generic
//!   Tilt-Rotor Aircraft*, NASA CR-166536 Rev. A, 1988. The reference model (GTRS) and its XV-15
//!   data. Taken: tables, gearing, structure, lists of symbols, all through transcriptions by others, as
//!   the trust labels in the aircraft file say. Doubted: single-source constants, and one column of wing
//!   lift (upright, flaps 40/25), with which CR537's printouts were not run.
//! - **CR537**: Ferguson, *Development and Validation of a Simulation for a Generic Tilt-Rotor
//!   Aircraft*, NASA CR-166537, 1989. Trim printouts, with the loads of every component.
//! - **TMX**: Maisel (ed.), *NASA/Army XV-15 Tilt Rotor Research Aircraft Familiarization Document*,
//!   NASA TM X-62,407, 1975. Geometry, weights, limits. Its 1975 predictions are superseded by flight.
//! - **TM812**: Dugan, Erhart, Schroers, *The XV-15 Tilt Rotor Research Aircraft*, NASA TM-81244,
//!   1980. Flown rotor speeds, procedures, ceilings.
//! - **CR176970**: Jordan, Patterson, Sandlin, *Approximate Determination of the Tilt Rotor Research
//!   Aircraft Rotor/Wing Download*, 1986. Hover power and download in flight.
//! - **TM89428**: Tischler, *Frequency-Response Identification of XV-15 Tilt-Rotor Aircraft Dynamics*,
//!   NASA TM-89428, 1987. Responses of pitch and heave identified in flight, through transcriptions.
//! - **KH**: Kleinhesselink, *Stability and Control Modeling of Tiltrotor Aircraft*, University of
//!   Maryland, 2007. A low-order airframe model.
//! - **TP04**: Acree, Peyran, Johnson, *Rotor Design Options for Improving XV-15 Whirl-Flutter Stability
//!   Margins*, NASA TP-2004-212262, 2004. Blade twist, chord, section tables, through transcriptions.
//! - **OARF**: Harris, *Hover Performance of Isolated Proprotors and Propellers*, NASA CR-2017-219486,
//!   Table A-2, run 15: the metal blades in hover on the outdoor test stand.
//! - **ISO2533**: *Standard Atmosphere*, 1975.
//! - **MIL8785**: MIL-F-8785C, *Flying Qualities of Piloted Airplanes*, 1980, section 3.7: wind shear,
//!   discrete gusts, Dryden turbulence.
//! - **PETERS**: Pitt and Peters, *Theoretical Prediction of Dynamic-Inflow Derivatives*, Vertica 5,
//!   1981. The three-state inflow.
//! - **GESSOW**: Gessow, Myers, *Aerodynamics of the Helicopter*, 1952. Inflow annulus by annulus.
//! - **BETZ**: Prandtl's appendix to Betz, *Schraubenpropeller mit geringstem Energieverlust*, 1919,
//!   as an end of lift: Johnson, *Helicopter Theory*, §2-6. Recalled with confidence.
//! - **LEISHMAN**: Leishman, *Principles of Helicopter Aerodynamics*, 2nd ed. Mean inflow in the vortex
//!   ring state, a fit to measurements; recalled.
//! - **TP213477**: Johnson, *Model for Vortex Ring State Influence on Rotor Flight Dynamics*, NASA
//!   TP-2005-213477, 2005. Where the vortex ring begins to be felt (Vc/vh = -0.2) and where it takes the
//!   damping of heave away (-0.45); recalled.
//! - **CORRIGAN**: Corrigan and Schillings, *Empirical Model for Stall Delay due to Rotation*, AHS
//!   Aeromechanics Specialists Conference, 1994. Rotational stall delay of lift; its constants, and that it
//!   leaves drag alone, as CR219086 has them for this rotor.
//! - **CR219086**: Koning, *XV-15 Tiltrotor Aerodynamics*, NASA CR-2016-219086, 2016, through a transcription by
//!   others. Blade sections and where they stand; thrust and power of the isolated rotor by a momentum-source
//!   solver with section tables of its own.
//! - **JOHNSON**: Johnson, *Helicopter Theory*, 1980. Gimbal and coning in multiblade coordinates.
//! - **KORN**: Korn's rule with Lock's fourth power, as in Mason, *Configuration Aerodynamics*. Drag
//!   divergence of a section; recalled.
//! - **CHEESEMAN**: Cheeseman and Bennett, *The Effect of the Ground on a Helicopter Rotor in Forward
//!   Flight*, ARC R&M 3021, 1955.
//! - **HAYDEN**: Hayden, *The Effect of the Ground on Helicopter Hovering Power Required*, 32nd
//!   Forum of the American Helicopter Society, 1976. Induced power near the ground, a fit to flights
//!   of several helicopters; recalled as Leishman gives it.
//! - **STEVENS**: Stevens, Lewis, Johnson, *Aircraft Control and Simulation*, 3rd ed. Rigid-body
//!   equations with quaternions.
//!
//! Trust labels of the aircraft file: `V` read in the document, `V-fig` read off its figure, `V-sec`
//! read in a transcription by others, `R+` recalled with confidence, `R?` recalled, `E` an
//! engineering estimate, never published.
