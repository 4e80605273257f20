# Written by the example xv15_package of flightgear-package from the aircraft file.

# The conversion corridor: [nacelle, deg; calibrated airspeed, kt].
var corridor_slow = [[90, 0], [85.1, 0], [85, 64], [76, 64], [68, 80], [60.5, 90], [47, 102], [29, 115], [16, 123], [0, 129]];
var corridor_fast = [[85, 96], [80, 117], [69.5, 128], [60, 144], [31, 169], [2.4, 169], [2.3, 234], [0, 234]];

# Limits of the scales.
var rated_rpm = 601;
var overspeed_rpm = 625;
var greatest_rpm = 661;
var cruise_kt = 260;
var dive_kt = 300;
var gear_cycle_kt = 160;
var flap_kt = [260, 220, 170, 100];
var flap_deg = [0, 20, 40, 75];
var governed_rpm = [589, 517, 458];
