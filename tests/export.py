"""Exports logs, reads the tables back with three engines, and compares with another reader of the logs.

Every eight bytes of every recorded message, taken from the log by the mcap package and named by the
schema in it, must be in the tables, to the bit. Then the queries of docs/queries.md are run as they stand.

Usage: export.py TILTROTOR FOLDER LOG...
"""

import csv
import math
import re
import struct
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import duckdb
import polars
import pyarrow.parquet as parquet
from mcap.stream_reader import StreamReader

RECORDED = ["/hardware", "/inputs", "/state", "/timing", "/events", "/outputs"]
NUMBERS = {"float64": "d", "uint64": "Q", "int64": "q"}


def numbers(schema):
    """Path and type of every number of a ros2msg definition, in order."""
    types, name = defaultdict(list), ""
    for line in schema.splitlines():
        if line.startswith("MSG: "):
            name = line[5:].strip()
        elif line and not line.startswith("="):
            types[name].append(line.split())

    def walk(of, path):
        for kind, field in types[of]:
            here = f"{path}.{field}" if path else field
            array = re.fullmatch(r"(\w+)\[(\d+)\]", kind)
            if array:
                for index in range(int(array[2])):
                    yield f"{here}[{index}]", NUMBERS[array[1]]
            elif kind in NUMBERS:
                yield here, NUMBERS[kind]
            else:
                yield from walk(kind, here)

    return list(walk("", ""))


def column(table, path):
    """The column's name, as docs/queries.md says."""
    return path.removeprefix(f"{table}.").replace(".", "_").replace("[", "_").replace("]", "")


def recorded(log):
    """By table: columns with their types, and the rows as bits."""
    tables = {}
    with open(log, "rb") as file:
        schemas, channels = {}, {}
        try:
            for record in StreamReader(file, validate_crcs=True).records:
                kind = type(record).__name__
                if kind == "Schema":
                    schemas[record.id] = record
                elif kind == "Channel":
                    channels[record.id] = record
                elif kind == "Message" and channels[record.channel_id].topic in RECORDED:
                    channel = channels[record.channel_id]
                    table = channel.topic[1:]
                    if table not in tables:
                        found = numbers(schemas[channel.schema_id].data.decode())
                        tables[table] = ([(column(table, p), kind) for p, kind in found], [])
                    columns, rows = tables[table]
                    rows.append((record.log_time, *struct.unpack(f"<{len(columns)}Q", record.data[4:])))
        except EOFError:
            pass
    return tables


def bits(values, kind):
    """Numbers as 64 bits each."""
    return list(struct.unpack(f"<{len(values)}Q", struct.pack(f"<{len(values)}{kind}", *values)))


def run(*arguments):
    return subprocess.run(arguments, capture_output=True, text=True)


def check_flight(tables, flight, log):
    """All values of a flight, by pyarrow, Polars and from CSV; returns how many."""
    count = 0
    for table, (columns, rows) in recorded(log).items():
        part = Path(table) / f"flight={flight}"
        arrow = parquet.ParquetFile(tables / "parquet" / part / "data.parquet").read()
        frame = polars.read_parquet(tables / "parquet" / part / "data.parquet", hive_partitioning=False)
        with open(tables / "csv" / part / "data.csv", newline="") as file:
            text = list(csv.reader(file))
        names = ["time_ns", "time_s", *(name for name, _ in columns)]
        assert arrow.column_names == names == frame.columns == text[0], f"columns of {table}"
        assert arrow.num_rows == frame.height == len(text) - 1 == len(rows), f"rows of {table}"
        kinds = ["Q", *(kind for _, kind in columns)]
        for place, (name, kind) in enumerate(zip(["time_ns", *names[2:]], kinds)):
            expected = [row[place] for row in rows]
            where = f"{table}.{name} of {flight}"
            assert bits(arrow[name].to_pylist(), kind) == expected, f"pyarrow: {where}"
            assert bits(frame[name].to_list(), kind) == expected, f"polars: {where}"
            index = names.index(name)
            number = float if kind == "d" else int
            assert bits([number(row[index]) for row in text[1:]], kind) == expected, f"csv: {where}"
            count += len(expected)
    return count


def main():
    tiltrotor, work, logs = sys.argv[1], Path(sys.argv[2]), sys.argv[3:]
    tables = work / "tables"
    flights = {}
    for form in ["parquet", "csv"]:
        said = run(tiltrotor, "log", "export", *logs, f"--{form}", str(tables / form))
        # One log of the corpus was never closed: 3. Nothing worse.
        assert said.returncode == 3, said
        names = re.findall(r"^(.*): (\S+), [\d.]+ [kMG]?B, rows", said.stdout, re.M)
        assert len(names) == len(logs), said.stdout
        assert flights in ({}, dict(names)), "the same names in both forms"
        flights = dict(names)
        again = run(tiltrotor, "log", "export", logs[0], f"--{form}", str(tables / form))
        assert again.returncode == 0 and "is there already" in again.stdout, again
    assert len(set(flights.values())) == len(logs), "two flights under one name"
    assert not list(tables.glob("*/.unfinished*")), "something was left behind"

    count = sum(check_flight(tables, flight, log) for log, flight in flights.items())
    print(f"{len(logs)} flights, {count} numbers: the same bits by pyarrow, polars and csv")

    sizes = {form: sum(f.stat().st_size for f in (tables / form).rglob("data.*")) for form in ["parquet", "csv"]}
    logged = sum(Path(log).stat().st_size for log in logs)
    print(f"logs {logged / 1e6:.1f} MB, Parquet {sizes['parquet'] / 1e6:.1f}, CSV {sizes['csv'] / 1e6:.1f}")

    # The queries, as they stand in the documentation.
    blocks = re.findall(r"```sql\n(.*?)```", Path("docs/queries.md").read_text(), re.S)
    duck = duckdb.connect()
    answers = {}
    for block in blocks:
        title = re.match(r"-- (\w+)", block)
        answer = duck.execute(block.replace("'tables/", f"'{tables / 'parquet'}/"))
        if title:
            answers[title[1]] = answer.fetchall()
            print(f"\n{title[1]}: {[column[0] for column in answer.description]}")
            for row in answers[title[1]]:
                print("  ", row)

    # DuckDB's answers from the messages themselves, without a table between.
    peaks, sinks, names = {}, {}, {flight: log for log, flight in flights.items()}
    for flight, log in names.items():
        found = recorded(log)
        columns, rows = found["outputs"]
        at = {name: index + 1 for index, (name, _) in enumerate(columns)}
        real = lambda word: struct.unpack("<d", struct.pack("<Q", word))[0]
        tilted = [
            real(row[at["load_factor"]])
            for row in rows
            if math.radians(1) <= real(row[at["actuators_mast_tilt_rad_right"]]) <= math.radians(89)
        ]
        if tilted:
            peaks[flight] = max(tilted)
        columns, rows = found["state"]
        at = {name: index + 1 for index, (name, _) in enumerate(columns)}
        falling = {row[at["tick"]]: real(row[at["plant_velocity_mps_z"]]) for row in rows}
        # tick, kind, value behind the time.
        for row in found.get("events", ([], []))[1]:
            tick, kind, value = row[1:4]
            if (kind, value) == (7, 1) and tick - 1 in falling:
                sinks[flight, tick] = falling[tick - 1]
    assert {row[0]: row[1] for row in answers["load_factor"]} == peaks, "load factors"
    assert len(peaks) >= 2, "conversions were flown"
    assert sorted(row[2] for row in answers["touchdown"]) == sorted(sinks.values()), "touchdowns"
    assert any(0 < sink < 3 for sink in sinks.values()), "the demo lands"
    assert sum(row[2] for row in answers["flown"]) == len(logs), "every flight has its row"
    # What an older version did not record is null, and what it did is there.
    nulls = duck.execute("SELECT count(*), count(plant_rotors_left_inflow_mean_mps) FROM state").fetchone()
    assert 0 < nulls[1] < nulls[0], nulls
    # DuckDB finds the same bits: the digests, which are whole numbers of 64 bits, and a float64.
    for flight, log in names.items():
        columns, rows = recorded(log)["state"]
        at = [name for name, _ in columns].index("plant_position_m_x") + 1
        found = duck.execute(
            "SELECT digest, plant_position_m_x FROM state WHERE flight = ? ORDER BY tick", [flight]
        ).fetchall()
        assert [digest for digest, _ in found] == [row[1] for row in rows], f"digests of {flight}"
        assert bits([x for _, x in found], "d") == [row[at] for row in rows], f"positions of {flight}"
    print("\nDuckDB's answers are those of the messages")


if __name__ == "__main__":
    main()
