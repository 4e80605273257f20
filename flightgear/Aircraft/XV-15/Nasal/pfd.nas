# Primary flight display, on the panel and over the picture.
#
# Every value comes from the channel below tiltrotor/; FlightGear's own instruments know nothing of
# this flight. A thing is changed only when what it shows has changed. What costs is the number of
# things that are drawn: so all that never changes in itself (frames, scales, the rose, the ladder) is
# drawn once, each to a sheet of its own, and is a single picture afterwards that moves as a whole.

var VIEW = 1000;
var PIXELS = 512;
var FONT = "LiberationFonts/LiberationSans-Bold.ttf";

var WHITE = [0.96, 0.97, 0.98];
var GREY = [0.62, 0.66, 0.70];
var DARK = [0.06, 0.07, 0.085];
var GREEN = [0.25, 0.92, 0.38];
var AMBER = [1.0, 0.74, 0.10];
var RED = [1.0, 0.22, 0.18];
var CYAN = [0.30, 0.85, 1.0];
var MAGENTA = [1.0, 0.45, 1.0];
var SKY = [0.13, 0.42, 0.76];
var GROUND = [0.44, 0.29, 0.14];

var display = nil;
var window = nil;
var timer = nil;

var node = func(path) props.globals.getNode("tiltrotor/" ~ path, 1);
var value = func(n) { var x = n.getValue(); return (x == nil) ? 0 : x; };
var clamp = func(x, low, high) (x < low) ? low : (x > high) ? high : x;
var nearest = func(x, step) math.floor(x / step + 0.5) * step;

# Something that is done only for a new value.
var memo = func(apply) {
    var last = nil;
    return func(x) {
        if (last != nil and x == last) return;
        last = x;
        apply(x);
    };
};

var text = func(group, what, x, y, size, color, align) {
    return group.createChild("text").setFont(FONT).setFontSize(size, 1).setColor(color)
        .setAlignment(align).setTranslation(x, y).setText(what);
};
var line = func(group, points, color, width) {
    var path = group.createChild("path").setColor(color).setStrokeLineWidth(width);
    for (var i = 0; i < size(points); i += 1) {
        if (points[i] == nil) continue;
        if (i == 0 or points[i - 1] == nil) path.moveTo(points[i][0], points[i][1]);
        else path.lineTo(points[i][0], points[i][1]);
    }
    return path;
};
var area = func(group, points, color) {
    var path = group.createChild("path").setColorFill(color);
    path.moveTo(points[0][0], points[0][1]);
    for (var i = 1; i < size(points); i += 1) path.lineTo(points[i][0], points[i][1]);
    return path.close();
};
var box = func(group, x, y, w, h, color)
    area(group, [[x, y], [x + w, y], [x + w, y + h], [x, y + h]], color);
var clip = func(group, x, y, w, h)
    group.set("clip", sprintf("rect(%d, %d, %d, %d)", y, x + w, y + h, x));

# A sheet to draw on once, w by h of the display's units, `scale` pixels a unit. Where nothing is drawn it
# is transparent, and white, so that white edges stay bright.
var sheets = [];
var sheet = func(name, w, h, scale, background = nil) {
    var made = canvas.new({ name: "XV-15 PFD " ~ name, size: [int(w * scale), int(h * scale)], view: [w, h], mipmapping: 0 });
    made.setColorBackground(background == nil ? [1, 1, 1, 0] : background);
    append(sheets, made);
    return made;
};
# A sheet as a picture in a group, its upper left at a place.
var picture = func(group, made, x, y) {
    var view = [made.get("view[0]"), made.get("view[1]")];
    return group.createChild("image").setFile(made.getPath()).setSize(view[0], view[1]).setTranslation(x, y);
};

# ---------------------------------------------------------------- horizon

var PITCH_PX = 9;
var HORIZON = [430, 375];

var Horizon = {
    new: func(on) {
        var m = { parents: [Horizon], roll: node("attitude/roll-deg"), pitch: node("attitude/pitch-deg"),
            slip: node("air/sideslip-deg") };
        var field = on.moving.createChild("group");
        clip(field, 162, 122, 536, 506);
        var turning = field.createChild("group").setCenter(HORIZON[0], HORIZON[1]);
        var ladder = turning.createChild("group");
        var (x, y) = HORIZON;
        # Sky and ground as one picture: filling an outline costs more than twice as much.
        var world = sheet("world", 8, 3200, 0.32, [SKY[0], SKY[1], SKY[2], 1]);
        box(world.createGroup(), 0, 1600, 8, 1600, GROUND);
        picture(ladder, world, x - 600, y - 1600).setSize(1200, 3200);
        line(ladder, [[x - 600, y], [x + 600, y]], WHITE, 5);
        var rungs = sheet("ladder", 260, 1500, 0.6);
        var marks = [];
        var drawn = rungs.createGroup();
        for (var deg = -80; deg <= 80; deg += 5) {
            if (deg == 0) continue;
            var half = math.fmod(deg, 10) == 0 ? 75 : 35;
            var up = 750 - deg * PITCH_PX;
            append(marks, [130 - half, up], [130 + half, up], nil);
            if (math.fmod(deg, 10) != 0) continue;
            var label = sprintf("%d", math.abs(deg));
            text(drawn, label, 130 - 84, up, 26, WHITE, "right-center");
            text(drawn, label, 130 + 84, up, 26, WHITE, "left-center");
        }
        line(drawn, marks, WHITE, 4);
        picture(ladder, rungs, x - 130, y - 750);
        # The pointer of bank, and below it the ball.
        var pointer = field.createChild("group").setCenter(x, y);
        area(pointer, [[x, 165], [x - 15, 190], [x + 15, 190]], WHITE);
        line(on.above, [[x - 22, 600], [x - 22, 624], nil, [x + 22, 600], [x + 22, 624]], WHITE, 3);
        var ball = field.createChild("path").setColorFill(WHITE).moveTo(x - 13, 612)
            .arcSmallCW(13, 13, 0, 26, 0).arcSmallCW(13, 13, 0, -26, 0);
        m.setRoll = memo(func(deg) {
            turning.setRotation(-deg * D2R);
            pointer.setRotation(-deg * D2R);
        });
        m.setPitch = memo(func(deg) ladder.setTranslation(0, deg * PITCH_PX));
        # The ball is where the wind comes from; step on it.
        m.setSlip = memo(func(px) ball.setTranslation(px, 0));
        return m;
    },
    update: func {
        me.setRoll(nearest(value(me.roll), 0.2));
        me.setPitch(nearest(value(me.pitch), 0.1));
        me.setSlip(nearest(clamp(value(me.slip), -15, 15) * 11, 1));
    },
};

# ---------------------------------------------------------------- airspeed

var KT_PX = 3.4;

var Airspeed = {
    new: func(on) {
        var m = { parents: [Airspeed], cas: node("air/cas-kt"), gs: node("air/groundspeed-kt"),
            low: node("corridor/speed-min-kt"), high: node("corridor/speed-max-kt"),
            excursion: node("corridor/excursion") };
        var field = on.moving.createChild("group");
        clip(field, 14, 122, 134, 506);
        var tape = field.createChild("group");
        var scale = sheet("airspeed", 124, 1400, 0.6);
        var drawn = scale.createGroup();
        var marks = [];
        for (var kt = -40; kt <= 360; kt += 10) {
            var y = 1240 - kt * KT_PX;
            append(marks, [104, y], [math.fmod(kt, 20) == 0 ? 122 : 114, y], nil);
            if (math.fmod(kt, 20) == 0) text(drawn, sprintf("%d", kt), 94, y, 27, WHITE, "right-center");
        }
        line(drawn, marks, WHITE, 3);
        picture(tape, scale, 12, 375 - 1240);
        # Beyond the corridor the tape's edge is red.
        var slow = box(tape, 137, 0, 11, 1400, RED);
        var fast = box(tape, 137, -1400, 11, 1400, RED);
        m.setTape = memo(func(kt) tape.setTranslation(0, kt * KT_PX));
        m.setLow = memo(func(kt) slow.setVisible(kt > 0).setTranslation(0, 375 - kt * KT_PX));
        m.setHigh = memo(func(kt) fast.setTranslation(0, 375 - kt * KT_PX));
        # The box of the digits hides what of the tape is below it.
        area(on.above, [[14, 345], [112, 345], [134, 375], [112, 405], [14, 405]], DARK);
        line(on.above, [[14, 345], [112, 345], [134, 375], [112, 405], [14, 405], [14, 345]], WHITE, 3);
        var digits = text(on.top, "0", 104, 376, 42, WHITE, "right-center");
        m.setDigits = memo(func(kt) digits.setText(sprintf("%d", kt)));
        m.setColor = memo(func(outside) digits.setColor(outside ? RED : WHITE));
        text(on.below, "CAS kt", 81, 100, 24, GREY, "center-center");
        var ground = text(on.top, "GS 0", 81, 648, 25, CYAN, "center-center");
        m.setGround = memo(func(kt) ground.setText(sprintf("GS %d", kt)));
        return m;
    },
    update: func {
        var kt = value(me.cas);
        me.setTape(nearest(kt, 0.3));
        me.setDigits(nearest(kt, 1));
        me.setLow(nearest(value(me.low), 0.5));
        me.setHigh(nearest(value(me.high), 0.5));
        me.setColor(value(me.excursion) != 0);
        me.setGround(nearest(value(me.gs), 1));
    },
};

# ---------------------------------------------------------------- height and climb

var FT_PX = 0.44;

var Height = {
    new: func(on) {
        var m = { parents: [Height], altitude: node("air/altitude-ft"), radar: node("air/radar-altitude-ft"),
            climb: node("air/vertical-speed-fpm"), labels: [] };
        var field = on.moving.createChild("group");
        clip(field, 712, 122, 154, 506);
        var tape = field.createChild("group");
        var marks = [];
        for (var i = -7; i <= 7; i += 1) {
            var y = 375 - i * 100 * FT_PX;
            append(marks, [714, y], [732, y], nil);
            append(m.labels, text(tape, "", 740, y, 25, WHITE, "left-center"));
        }
        line(tape, marks, WHITE, 3);
        m.setOffset = memo(func(px) tape.setTranslation(0, px));
        m.setBase = memo(func(base) {
            for (var i = 0; i < size(m.labels); i += 1)
                m.labels[i].setText(sprintf("%d", base + (i - 7) * 100));
        });
        area(on.above, [[866, 345], [750, 345], [728, 375], [750, 405], [866, 405]], DARK);
        line(on.above, [[866, 345], [750, 345], [728, 375], [750, 405], [866, 405], [866, 345]], WHITE, 3);
        var digits = text(on.top, "0", 858, 376, 36, WHITE, "right-center");
        m.setDigits = memo(func(ft) digits.setText(sprintf("%d", ft)));
        text(on.below, "ALT ft", 789, 100, 24, GREY, "center-center");
        # Radar height, in the horizon's corner.
        box(on.above, 556, 576, 142, 52, DARK);
        var radar = text(on.top, "", 690, 603, 36, GREEN, "right-center");
        text(on.above, "RA", 564, 603, 22, GREY, "left-center");
        m.setRadar = memo(func(ft) {
            radar.setText(ft > 2500 ? "----" : sprintf("%d", ft));
            radar.setColor(ft < 50 ? AMBER : GREEN);
        });
        # Climb: the scale is finer around level flight.
        text(on.below, "VS fpm", 933, 100, 24, GREY, "center-center");
        var marks = [];
        foreach (var fpm; [-3000, -2000, -1000, -500, 0, 500, 1000, 2000, 3000]) {
            var y = Height.climbY(fpm);
            append(marks, [884, y], [900, y], nil);
            if (fpm != 0) text(on.below, sprintf("%g", math.abs(fpm) / 1000), 908, y, 23, WHITE, "left-center");
        }
        line(on.below, marks, WHITE, 3);
        var bar = area(on.moving, [[880, -8], [968, -8], [986, 0], [968, 8], [880, 8]], CYAN);
        m.setClimb = memo(func(y) bar.setTranslation(0, y));
        box(on.above, 880, 586, 106, 42, DARK);
        var rate = text(on.top, "0", 982, 608, 29, WHITE, "right-center");
        m.setRate = memo(func(fpm) {
            rate.setText(sprintf("%+d", fpm));
            rate.setColor(fpm < -800 ? AMBER : WHITE);
        });
        return m;
    },
    climbY: func(fpm) {
        var x = clamp(math.abs(fpm), 0, 3200);
        var px = (x < 1000) ? x * 0.115 : 115 + (x - 1000) * 0.043;
        return 360 - (fpm < 0 ? -px : px);
    },
    update: func {
        var ft = value(me.altitude);
        var base = nearest(ft, 100);
        me.setBase(base);
        me.setOffset(nearest((ft - base) * FT_PX, 0.5));
        me.setDigits(nearest(ft, 1));
        var radar = value(me.radar);
        me.setRadar(radar < 0.5 ? 0 : nearest(radar, radar < 100 ? 1 : 10));
        var fpm = value(me.climb);
        me.setClimb(nearest(Height.climbY(fpm), 1));
        me.setRate(nearest(fpm, 50) + 0);
    },
};

# ---------------------------------------------------------------- compass

var Compass = {
    new: func(on) {
        var m = { parents: [Compass], heading: node("attitude/heading-deg"), turn: node("attitude/turn-rate-degps") };
        var (x, y, r) = (430, 838, 142);
        on.below.createChild("path").setColorFill(DARK).moveTo(x - r, y).arcSmallCW(r, r, 0, 2 * r, 0)
            .arcSmallCW(r, r, 0, -2 * r, 0).setColor(GREY).setStrokeLineWidth(3);
        var rose = on.moving.createChild("group").setCenter(x, y);
        var face = sheet("rose", 2 * r + 4, 2 * r + 4, 1);
        var drawn = face.createGroup().setTranslation(r + 2 - x, r + 2 - y);
        var marks = [];
        for (var deg = 0; deg < 360; deg += 10) {
            var (s, c) = (math.sin(deg * D2R), -math.cos(deg * D2R));
            var inner = math.fmod(deg, 30) == 0 ? r - 20 : r - 11;
            append(marks, [x + r * s, y + r * c], [x + inner * s, y + inner * c], nil);
            if (math.fmod(deg, 30) != 0) continue;
            var name = { "0": "N", "90": "E", "180": "S", "270": "W" };
            var key = sprintf("%d", deg);
            var label = contains(name, key) ? name[key] : sprintf("%d", deg / 10);
            text(drawn, label, x + (r - 37) * s, y + (r - 37) * c, 27,
                contains(name, key) ? AMBER : WHITE, "center-center").setRotation(deg * D2R);
        }
        line(drawn, marks, WHITE, 3);
        picture(rose, face, x - r - 2, y - r - 2);
        # The aircraft from above.
        line(on.above, [[x, y - 34], [x, y + 30], nil, [x - 30, y - 6], [x + 30, y - 6], nil,
            [x - 14, y + 26], [x + 14, y + 26]], AMBER, 6);
        m.setHeading = memo(func(deg) rose.setRotation(-deg * D2R));
        box(on.above, 388, 634, 84, 40, DARK);
        line(on.above, [[388, 634], [472, 634], [472, 674], [388, 674], [388, 634]], WHITE, 2);
        var digits = text(on.top, "000", 430, 655, 33, WHITE, "center-center");
        m.setDigits = memo(func(deg) digits.setText(sprintf("%03d", deg)));
        # Turn: where the heading will be after six seconds.
        var trend = on.moving.createChild("group").setCenter(x, y);
        area(trend, [[x, y - r], [x - 9, y - r - 14], [x + 9, y - r - 14]], MAGENTA);
        m.setTurn = memo(func(deg) trend.setRotation(deg * D2R));
        return m;
    },
    update: func {
        var deg = value(me.heading);
        me.setHeading(nearest(deg, 0.25));
        var whole = math.fmod(nearest(deg, 1), 360);
        me.setDigits(whole);
        me.setTurn(nearest(clamp(value(me.turn) * 6, -60, 60), 0.5));
    },
};

# ---------------------------------------------------------------- conversion corridor

var Corridor = {
    new: func(on) {
        var m = { parents: [Corridor], cas: node("air/cas-kt"), nacelle: node("nacelle-deg"),
            excursion: node("corridor/excursion") };
        text(on.below, "CORRIDOR", 142, 684, 22, GREY, "center-center");
        var limit = func(points) {
            var line_points = [];
            foreach (var p; points) append(line_points, Corridor.place(p[1], p[0]));
            return line_points;
        };
        var slow = limit(corridor_slow);
        var fast = limit(corridor_fast);
        # The flown side between both limits; above the fast limit's end it goes straight up.
        var outline = [Corridor.place(0, 95)] ~ slow;
        var back = [];
        for (var i = size(fast) - 1; i >= 0; i -= 1) append(back, fast[i]);
        outline = outline ~ back ~ [[fast[0][0], Corridor.place(0, 95)[1]]];
        area(on.below, outline, [0.10, 0.27, 0.16]);
        line(on.below, slow, GREEN, 4);
        line(on.below, fast, GREEN, 4);
        line(on.below, [Corridor.place(0, 95), Corridor.place(0, 0), Corridor.place(250, 0)], GREY, 3);
        foreach (var kt; [0, 100, 200]) {
            var at = Corridor.place(kt, 0);
            line(on.below, [at, [at[0], at[1] + 8]], GREY, 3);
            text(on.below, sprintf("%d", kt), at[0], at[1] + 20, 20, GREY, "center-center");
        }
        foreach (var deg; [0, 30, 60, 90]) {
            var at = Corridor.place(0, deg);
            line(on.below, [at, [at[0] - 7, at[1]]], GREY, 3);
            text(on.below, sprintf("%d", deg), at[0] - 10, at[1], 20, GREY, "right-center");
        }
        var point = on.moving.createChild("group");
        var dot = point.createChild("path").setColor([0, 0, 0]).setStrokeLineWidth(2).moveTo(-10, 0)
            .arcSmallCW(10, 10, 0, 20, 0).arcSmallCW(10, 10, 0, -20, 0);
        m.setPoint = func(x, y) {
            if (m["x"] == x and m["y"] == y) return;
            m.x = x;
            m.y = y;
            point.setTranslation(x, y);
        };
        m.setColor = memo(func(outside) dot.setColorFill(outside ? RED : WHITE));
        return m;
    },
    # Of airspeed, kt, and nacelle, deg.
    place: func(kt, deg) [52 + kt * 0.84, 950 - deg * 2.62],
    update: func {
        var at = Corridor.place(clamp(value(me.cas), -10, 255), value(me.nacelle));
        me.setPoint(nearest(at[0], 1), nearest(at[1], 1));
        me.setColor(value(me.excursion) != 0);
    },
};

# ---------------------------------------------------------------- rotors, nacelles, flaps, gear

var BAR_Y = 905;
var BAR_PX = 1.72;

# An upright bar of per cent with its number below.
var Bar = {
    new: func(on, name, x, limit, color_of) {
        var m = { parents: [Bar], color_of: color_of };
        box(on.below, x, BAR_Y - 125 * BAR_PX, 34, 125 * BAR_PX, [0.16, 0.18, 0.20]);
        var bar = on.moving.createChild("group");
        var level = box(bar, 0, 0, 34, 1, GREEN);
        bar.setTranslation(x, BAR_Y);
        line(on.above, [[x - 5, BAR_Y - limit * BAR_PX], [x + 39, BAR_Y - limit * BAR_PX]], RED, 4);
        text(on.below, name, x + 17, 670, 22, GREY, "center-center");
        var digits = text(on.top, "0", x + 17, 928, 27, WHITE, "center-center");
        m.setLevel = memo(func(px) level.setScale(1, -px));
        m.setDigits = memo(func(x) digits.setText(sprintf("%d", x)));
        m.setColor = memo(func(i) {
            level.setColorFill([GREEN, AMBER, RED][i]);
            digits.setColor([WHITE, AMBER, RED][i]);
        });
        return m;
    },
    update: func(percent) {
        me.setLevel(math.max(1, nearest(clamp(percent, 0, 125) * BAR_PX, 1)));
        me.setDigits(nearest(percent, 1));
        me.setColor(me.color_of(percent));
    },
};

var Systems = {
    new: func(on) {
        var m = { parents: [Systems], rpm: node("rotor/rpm"), torque: [node("rotor[0]/torque-percent"),
            node("rotor[1]/torque-percent")], command: node("rpm-command"), slow: node("lamp/low-rotor-rpm"),
            nacelle: node("nacelle-deg"), flap: node("surface/flap-deg"), detent: node("flap-detent"),
            gear: [node("gear/unit[0]/position-norm"), node("gear/unit[1]/position-norm"),
            node("gear/unit[2]/position-norm")], handle: node("gear/handle-down") };
        var torque = func(percent) percent > 115 ? 2 : percent > 100 ? 1 : 0;
        m.left = Bar.new(on, "TQ L", 616, 100, torque);
        m.right = Bar.new(on, "TQ R", 674, 100, torque);
        m.rotor = Bar.new(on, "NR %", 740, overspeed_rpm / rated_rpm * 100, func(percent) {
            return percent > overspeed_rpm / rated_rpm * 100 or value(m.slow) ? 2 : 0;
        });
        # The governor's speed beside the bar.
        var bug = area(on.moving, [[778, 0], [792, -8], [792, 8]], CYAN);
        m.setBug = memo(func(y) bug.setTranslation(0, y));
        var speed = text(on.moving, "0", 757, 960, 25, WHITE, "center-center");
        m.setSpeed = memo(func(rpm) speed.setText(sprintf("%d", rpm)));
        text(on.below, "RPM", 672, 960, 22, GREY, "center-center");

        # Nacelles: from ahead to upright on a quarter of a circle.
        var (x, y, r) = (828, 792, 112);
        text(on.below, "NAC", 862, 670, 22, GREY, "center-center");
        var marks = [];
        foreach (var deg; [0, 15, 30, 45, 60, 75, 90, 95]) {
            var (s, c) = (math.sin(deg * D2R), math.cos(deg * D2R));
            var inner = math.fmod(deg, 30) == 0 ? r - 18 : r - 9;
            append(marks, [x + inner * c, y - inner * s], [x + r * c, y - r * s], nil);
        }
        line(on.below, marks, WHITE, 3);
        var needle = on.moving.createChild("group").setTranslation(x, y);
        area(needle, [[0, -6], [r - 24, -5], [r - 2, 0], [r - 24, 5], [0, 6]], GREEN);
        m.setNeedle = memo(func(deg) needle.setRotation(-deg * D2R));
        var angle = text(on.moving, "90", 982, 690, 38, WHITE, "right-center");
        m.setAngle = memo(func(deg) angle.setText(sprintf("%d", deg)));

        # Flaps: where they are, and where the lever is.
        line(on.below, [[806, 812], [986, 812], nil, [806, 888], [986, 888]], [0.36, 0.40, 0.44], 2);
        text(on.below, "FLAPS", 816, 832, 22, GREY, "left-center");
        var flap = text(on.moving, "0", 982, 832, 31, WHITE, "right-center");
        m.setFlap = memo(func(deg) flap.setText(sprintf("%d", deg)));
        m.setFlapColor = memo(func(moving) flap.setColor(moving ? AMBER : WHITE));
        line(on.below, [[820, 866], [970, 866]], GREY, 4);
        foreach (var deg; flap_deg) line(on.below, [[820 + deg * 2, 858], [820 + deg * 2, 874]], GREY, 3);
        var lever = area(on.moving, [[-9, 848], [9, 848], [0, 862]], CYAN);
        m.setLever = memo(func(deg) lever.setTranslation(820 + deg * 2, 0));
        var surface = box(on.moving, 0, 860, 1, 12, GREEN);
        surface.setTranslation(820, 0);
        m.setSurface = memo(func(px) surface.setScale(px, 1));

        # Gear: nose above, mains below; green down, amber moving, grey up.
        text(on.below, "GEAR", 816, 910, 22, GREY, "left-center");
        m.lamps = [];
        foreach (var at; [[932, 897], [896, 940], [950, 940]]) {
            var lamp = box(on.moving, at[0] - 20, at[1], 40, 34, DARK);
            append(m.lamps, Systems.lamp(lamp));
        }
        var handle = text(on.moving, "DN", 838, 952, 28, GREEN, "center-center");
        m.setHandle = memo(func(down) handle.setText(down ? "DN" : "UP"));
        return m;
    },
    lamp: func(lamp) {
        lamp.setColor(GREY).setStrokeLineWidth(2);
        return memo(func(i) lamp.setColorFill([DARK, AMBER, GREEN][i]));
    },
    update: func {
        me.left.update(value(me.torque[0]));
        me.right.update(value(me.torque[1]));
        var rpm = value(me.rpm);
        me.rotor.update(rpm / rated_rpm * 100);
        me.setSpeed(nearest(rpm, 1));
        me.setBug(nearest(BAR_Y - value(me.command) / rated_rpm * 100 * BAR_PX, 1));
        var deg = value(me.nacelle);
        me.setNeedle(nearest(deg, 0.5));
        me.setAngle(nearest(deg, 1));
        var flap = value(me.flap);
        var selected = flap_deg[clamp(value(me.detent), 0, size(flap_deg) - 1)];
        me.setFlap(nearest(flap, 1));
        me.setFlapColor(math.abs(flap - selected) > 1);
        me.setLever(selected);
        me.setSurface(math.max(1, nearest(flap * 2, 1)));
        forindex (var i; me.gear) {
            var out = value(me.gear[i]);
            me.lamps[i](out > 0.99 ? 2 : out < 0.01 ? 0 : 1);
        }
        me.setHandle(value(me.handle) != 0);
    },
};

# ---------------------------------------------------------------- annunciators

var Annunciators = {
    new: func(on) {
        var m = { parents: [Annunciators], lamps: [] };
        # Above: what works, what is recorded. Name, place, and of the channel: lit or not, and how.
        var state = func(name, x, w, of) append(m.lamps, [Annunciators.lamp(on, name, x, 8, w), of]);
        var works = func(path) { var n = node(path); return func value(n) ? ["", GREEN, 0] : ["", AMBER, 1]; };
        state("SCAS P", 12, 112, works("scas/pitch"));
        state("SCAS R", 132, 112, works("scas/roll"));
        state("SCAS Y", 252, 112, works("scas/yaw"));
        state("GOV", 372, 84, works("governor/on"));
        var command = node("rpm-select");
        state("", 464, 106, func [["HELI", "APLN 1", "APLN 2"][clamp(value(command), 0, 2)], CYAN, 0]);
        var recording = node("lamp/recording");
        state("REC", 578, 100, func {
            var x = value(recording);
            return x == 2 ? ["REC FAIL", RED, 1] : x == 1 ? ["REC", RED, 0] : ["NO REC", GREY, 0];
        });
        var marker = node("lamp/marker");
        state("MKR", 686, 98, func {
            var x = value(marker);
            return x > 0 ? [sprintf("MKR %d", x), MAGENTA, 0] : ["MKR", GREY, 0];
        });
        var replay = node("lamp/replay");
        var paused = node("lamp/paused");
        state("", 792, 196, func value(paused) ? ["PAUSED", AMBER, 1] : value(replay) ? ["REPLAY", CYAN, 0] : ["LIVE", GREEN, 0]);
        # Below: warnings, each in its place, dark until there is one.
        var warning = func(name, x, w, path, color) {
            var n = node(path);
            append(m.lamps, [Annunciators.lamp(on, name, x, 48, w), func value(n) ? [name, color, 1] : ["", GREY, 0]]);
        };
        warning("MASTER", 12, 112, "lamp/master-warning", RED);
        warning("STALL", 132, 100, "lamp/stall", RED);
        warning("ENG L", 240, 100, "lamp/engine-fail[0]", RED);
        warning("ENG R", 348, 100, "lamp/engine-fail[1]", RED);
        warning("LOW RPM", 456, 130, "lamp/low-rotor-rpm", RED);
        warning("TORQUE", 594, 122, "lamp/torque-limit", AMBER);
        warning("GEAR", 724, 94, "lamp/gear-warning", RED);
        var excursion = node("corridor/excursion");
        append(m.lamps, [Annunciators.lamp(on, "CORRIDOR", 826, 48, 162), func {
            var x = value(excursion);
            return x > 0 ? ["TOO FAST", RED, 1] : x < 0 ? ["TOO SLOW", RED, 1] : ["", GREY, 0];
        }]);
        return m;
    },
    # A lamp: [words, colour, whether the whole field is lit].
    lamp: func(on, name, x, y, w) {
        box(on.below, x, y, w, 34, [0.10, 0.11, 0.13]);
        var field = box(on.moving, x, y, w, 34, RED).setVisible(0);
        var label = text(on.top, name, x + w / 2, y + 18, 23, GREY, "center-center");
        var last = [nil, nil, nil];
        return func(state) {
            if (last[0] == state[0] and last[1] == state[1] and last[2] == state[2]) return;
            last = state;
            if (state[0] != "" or name == "") label.setText(state[0]);
            label.setVisible(state[1] != GREY or name == "REC" or name == "MKR");
            field.setVisible(state[2]);
            if (state[2]) field.setColorFill(state[1]);
            label.setColor(state[2] ? DARK : state[1]);
        };
    },
    update: func {
        foreach (var lamp; me.lamps) lamp[0](lamp[1]());
    },
};

# ---------------------------------------------------------------- the display as a whole

var parts = [];

var build = func {
    display = canvas.new({ name: "XV-15 PFD", size: [PIXELS, PIXELS], view: [VIEW, VIEW], mipmapping: 0 });
    var root = display.createGroup();
    # What stands still below all that moves, what moves, what stands still above it, digits and words.
    var below = sheet("below", VIEW, VIEW, PIXELS / VIEW, [0.015, 0.018, 0.022, 1]);
    var above = sheet("above", VIEW, VIEW, PIXELS / VIEW);
    picture(root, below, 0, 0);
    var moving = root.createChild("group");
    picture(root, above, 0, 0);
    var on = { below: below.createGroup(), moving: moving, above: above.createGroup(),
        top: root.createChild("group") };
    canvas.parsesvg(on.above, "Aircraft/XV-15/Display/pfd.svg");
    parts = [Horizon.new(on), Airspeed.new(on), Height.new(on), Compass.new(on), Corridor.new(on),
        Systems.new(on), Annunciators.new(on)];
    foreach (var side; ["left", "right"]) display.addPlacement({ node: "pfd." ~ side });
};

var update = func {
    foreach (var part; parts) part.update();
};

# Over the picture: 0 never, 1 outside, 2 always.
var overlay = props.globals.getNode("sim/tiltrotor/overlay", 1);
var overlay_size = props.globals.getNode("sim/tiltrotor/overlay-size-norm", 1);

# Off: nothing is looked up or drawn, on the panel neither.
var lit = props.globals.getNode("sim/tiltrotor/display", 1);

var power = func {
    if (value(lit)) timer.start();
    else timer.stop();
    show();
};

var show = func {
    var mode = value(lit) ? value(overlay) : 0;
    var inside = getprop("/sim/current-view/internal");
    var wanted = mode == 2 or (mode == 1 and !inside);
    if (!wanted) {
        if (window != nil) window.hide();
        return;
    }
    var (w, h) = (getprop("/sim/startup/xsize"), getprop("/sim/startup/ysize"));
    var side = int(math.min(w, h) * value(overlay_size));
    if (window == nil) {
        window = canvas.Window.new([side, side]);
        window.setCanvas(display);
    }
    window.setSize(side, side);
    window.setPosition(8, h - side - 8);
    window.show();
};

var cycle = func {
    overlay.setValue(math.fmod(value(overlay) + 1, 3));
    gui.popupTip(["display: on the panel only", "display: panel, and over outside views", "display: over every view"][value(overlay)], 2);
};

var start = func {
    if (overlay.getValue() == nil) overlay.setValue(1);
    if (overlay_size.getValue() == nil) overlay_size.setValue(0.56);
    if (lit.getValue() == nil) lit.setValue(1);
    build();
    timer = maketimer(0.04, update);
    timer.simulatedTime = 0;
    setlistener(lit, power, 1, 0);
    setlistener(overlay, show, 0, 0);
    setlistener("/sim/current-view/internal", show, 0, 0);
    foreach (var axis; ["xsize", "ysize"]) setlistener("/sim/startup/" ~ axis, show, 0, 0);
};

var started = 0;
setlistener("/sim/signals/fdm-initialized", func {
    if (started) return;
    started = 1;
    start();
}, 1, 0);
