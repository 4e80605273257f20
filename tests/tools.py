"""Writes a flight log anew as other people's MCAP tools do, and asks every verb what it is.

The official command's compress, decompress, sort and filter put attachments and metadata last; here
Python's `mcap` writes what they write. The same flight is exact, and read the same; a log whose
messages stand in another order or lack a channel is refused, and every verb says why.

Usage: tools.py FLIGHT.mcap TILTROTOR FOLDER
"""

import subprocess
import sys
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, IndexType, Writer

RECORDED = ("/hardware", "/inputs", "/state")
STRING = b"\0\x01\0\0\x01\0\0\0\0"


class Log:
    """Everything in a log, in the order of the file."""

    def __init__(self, path):
        with open(path, "rb") as file:
            reader = make_reader(file, validate_crcs=True)
            self.schemas = reader.get_summary().schemas
            self.channels = reader.get_summary().channels
            self.messages = [m for _, _, m in reader.iter_messages(log_time_order=False)]
            self.attachments = list(reader.iter_attachments())
            self.metadata = list(reader.iter_metadata())

    def write(self, path, *, keep=lambda topic: True, theirs=False, order=None, **options):
        """As a tool writes it: messages first, then attachments and metadata."""
        with open(path, "wb") as file:
            writer = Writer(file, **options)
            writer.start(profile="ros2", library="another tool")
            schema_ids, channel_ids = {}, {}
            for number, channel in self.channels.items():
                if not keep(channel.topic):
                    continue
                schema = self.schemas[channel.schema_id]
                if schema.id not in schema_ids:
                    schema_ids[schema.id] = writer.register_schema(
                        schema.name, schema.encoding, schema.data
                    )
                channel_ids[number] = writer.register_channel(
                    channel.topic, channel.message_encoding, schema_ids[schema.id], channel.metadata
                )
            if theirs:
                schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
                their_id = writer.register_channel("/theirs", "cdr", schema)
            messages = sorted(self.messages, key=order) if order else self.messages
            for place, message in enumerate(messages):
                if message.channel_id in channel_ids:
                    writer.add_message(
                        channel_ids[message.channel_id],
                        message.log_time,
                        message.data,
                        message.publish_time,
                        message.sequence,
                    )
                if theirs and place % 100 == 0:
                    writer.add_message(their_id, message.log_time, STRING, message.log_time)
            for a in self.attachments:
                writer.add_attachment(a.create_time, a.log_time, a.name, a.media_type, a.data)
            if theirs:
                writer.add_attachment(0, 0, "notes.txt", "text/plain", b"a note of somebody else's\n")
            for record in self.metadata:
                writer.add_metadata(record.name, record.metadata)
            writer.finish()


def run(tiltrotor, *arguments):
    """Exit status and both outputs."""
    done = subprocess.run(
        [tiltrotor, *map(str, arguments)], capture_output=True, text=True, check=False
    )
    assert "panicked" not in done.stderr, done
    return done.returncode, done.stdout, done.stderr


def digest(text):
    """The digest that a verb prints."""
    return text.split("digest")[1].split()[0].rstrip(",;")


def as_flown(tiltrotor, log, flown, folder):
    """The log is the flown one to every verb."""
    status, out, err = run(tiltrotor, "verify", log)
    assert status == 0 and ": exact: all " in out, (log, out, err)
    assert digest(out) == flown, (log, out)
    status, out, err = run(tiltrotor, "log", "info", log)
    assert status == 0 and digest(out) == flown and "  end of the log   closed" in out.splitlines(), (log, out, err)
    status, out, err = run(tiltrotor, "log", "files", log)
    assert status == 0 and "aircraft.toml" in out, (log, out, err)
    compact = folder / "compact.mcap"
    status, out, err = run(tiltrotor, "log", "compact", log, "--force", "--out", compact)
    assert status == 0, (log, out, err)
    status, out, err = run(tiltrotor, "verify", compact)
    assert status == 0 and digest(out) == flown, (log, out, err)
    status, out, err = run(tiltrotor, "log", "recover", log, "--out", folder / "none.mcap")
    assert status == 2 and "it is whole" in err, (log, out, err)


def refused(tiltrotor, log, folder, why):
    """No verb takes it for the flight that was flown, and each says the same reason."""
    out = folder / "refused.mcap"
    out.unlink(missing_ok=True)
    for verb in (("verify", log), ("log", "info", log)):
        status, *said = run(tiltrotor, *verb)
        assert status in (1, 2) and why in "".join(said), (verb, status, said)
    status, *said = run(tiltrotor, "log", "compact", log, "--out", out)
    # One that makes a log has no place for a diagnosis: it says who has.
    assert status == 2, (log, status, said)
    assert why in said[1] or "`tiltrotor verify` says more" in said[1], (log, said)
    out.unlink(missing_ok=True)
    status, *said = run(tiltrotor, "log", "recover", log, "--out", out)
    assert why in "".join(said), (log, said)
    assert status == 2 or run(tiltrotor, "verify", out)[0] == 3, (log, status, said)


def main():
    log, tiltrotor, folder = sys.argv[1], sys.argv[2], Path(sys.argv[3])
    source = Log(log)
    _, out, _ = run(tiltrotor, "verify", log)
    flown = digest(out)
    big = {"chunk_size": 4 << 20}
    same = {
        "compress-zstd": {"compression": CompressionType.ZSTD},
        "compress-lz4": {"compression": CompressionType.LZ4, **big},
        "decompress": {"compression": CompressionType.NONE},
        "small-chunks": {"compression": CompressionType.LZ4, "chunk_size": 20_000},
        "no-chunks": {"use_chunking": False},
        "no-index": {
            "compression": CompressionType.ZSTD,
            "index_types": IndexType.NONE,
            "repeat_channels": False,
            "repeat_schemas": False,
        },
        "theirs": {"compression": CompressionType.LZ4, "theirs": True},
        # Log times never go back: sorted by them, a log is what it was.
        "sort": {"compression": CompressionType.LZ4, "order": lambda m: m.log_time},
    }
    for name, options in same.items():
        path = folder / f"{name}.mcap"
        source.write(path, **options)
        as_flown(tiltrotor, path, flown, folder)
        print(f"{name:16} the same flight")
    rest = "is not as written, though every checksum is right"
    for name, why, options in (
        ("filter-state", "before the first /state", {"keep": lambda topic: topic != "/state"}),
        ("filter-inputs", "tick 1 has no inputs", {"keep": lambda topic: topic != "/inputs"}),
        ("filter-hardware", "device events, got 0", {"keep": lambda topic: topic != "/hardware"}),
        ("filter-views", rest, {"keep": lambda topic: topic in RECORDED}),
    ):
        path = folder / f"{name}.mcap"
        source.write(path, compression=CompressionType.LZ4, **options)
        refused(tiltrotor, path, folder, why)
        print(f"{name:16} refused: {why}")


if __name__ == "__main__":
    main()
