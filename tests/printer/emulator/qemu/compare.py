#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares a captured print with a job file: the layer records on the wire are those of the file.

compare.py CAPTURE.pcap JOB.bjob [SPOOLED.bjob]

tshark decodes the capture. Frames (transport/PROTOCOL.md) and job files (transport/job/job_format.h)
are taken apart here, by the pages that describe them and not by the program's own code.
"""
import hashlib
import struct
import subprocess
import sys

BULK_OUT = "usb.transfer_type == 3 && usb.endpoint_address.direction == 0"
FIELDS = ["usb.urb_id", "usb.urb_type", "usb.urb_status", "usb.urb_len", "usb.data_len",
          "usb.bus_id", "usb.device_address", "usb.capdata"]
FRAME_HEAD = struct.Struct("<4sB3sIIQQ")
LAYER = 4
LAYER_HEAD_BYTES = 16
JOB = 2
END = 5


class Mismatch(Exception):
    pass


def need(condition, what):
    if not condition:
        raise Mismatch(what)


def wire_bytes(capture):
    """What the bulk OUT pipe carried: each transfer's bytes, as many as its completion counts."""
    # Dissectors of printer languages would take the payload away.
    command = ["tshark", "-n", "-r", capture, "-Y", BULK_OUT, "-T", "fields"]
    for field in FIELDS:
        command += ["-e", field]
    decoded = subprocess.run(command, capture_output=True, text=True)
    need(decoded.returncode == 0, f"tshark: {decoded.stderr}")
    lines = decoded.stdout
    order, sent, taken, open_urbs, devices = [], {}, {}, {}, set()
    for number, line in enumerate(lines.splitlines()):
        urb, kind, status, length, data_length, bus, device, data = line.split("\t")
        kind = kind.strip("'")
        devices.add((bus, device))
        if kind == "S":
            need(int(length) == int(data_length), f"transfer {number} is cut in the capture")
            need(urb not in open_urbs, f"transfer {number} was submitted twice")
            open_urbs[urb] = number
            order.append(number)
            sent[number] = bytes.fromhex(data.replace(":", ""))
            need(len(sent[number]) == int(length), f"transfer {number}: tshark shows fewer bytes")
        else:
            number = open_urbs.pop(urb)
            need(int(status) == 0, f"transfer {number} ended with {status}")
            taken[number] = int(length)
    need(not open_urbs, "a transfer never completed")
    need(len(devices) == 1, f"{len(devices)} devices in the capture")
    return b"".join(sent[n][:taken[n]] for n in order), len(order)


def frames(stream):
    """Yields (type, sequence, payload) until the stream ends, which must be between two frames."""
    at = 0
    while at < len(stream):
        need(at + FRAME_HEAD.size <= len(stream), f"a frame is cut at byte {at}")
        magic, kind, zero, sequence, length, _, _ = FRAME_HEAD.unpack_from(stream, at)
        need(magic == b"BJU1" and zero == bytes(3), f"no frame at byte {at}")
        at += FRAME_HEAD.size
        need(at + length <= len(stream), f"frame {sequence} is cut")
        yield kind, sequence, stream[at:at + length]
        at += length


def job_parts(path):
    """Header, and all records as one run of bytes, of a whole job file."""
    with open(path, "rb") as file:
        data = file.read()
    need(data[:8] == b"BJOB\r\n\x1a\n", f"{path} is no job")
    header_bytes, = struct.unpack_from("<Q", data, 16)
    need(data[-40:-36] == b"BJEN", f"{path} is not whole")
    index_at, = struct.unpack_from("<Q", data, len(data) - 32)
    return data[32:32 + header_bytes], data[32 + header_bytes:index_at]


def layers_of(records):
    """The numbers of the layers in a run of records, ascending."""
    numbers, at = [], 0
    while at < len(records):
        need(records[at:at + 4] == b"BJLR", f"no record at byte {at}")
        layer, _, frame_bytes = struct.unpack_from("<III", records, at + 8)
        if not numbers or numbers[-1] != layer:
            numbers.append(layer)
        at += 40 + frame_bytes
    return numbers


def main(capture, job, *spooled):
    header, records = job_parts(job)
    for other in spooled:
        need(job_parts(other) == (header, records), f"{other} differs from {job}")
    stream, transfers = wire_bytes(capture)
    sent_header, sent, numbers, kinds = b"", [], [], []
    for kind, sequence, payload in frames(stream):
        need(sequence == len(kinds), f"frame {len(kinds)} has the number {sequence}")
        kinds.append(kind)
        if kind == JOB:
            sent_header = payload
        elif kind == LAYER:
            numbers.append(struct.unpack_from("<QI", payload)[1])
            sent.append(payload[LAYER_HEAD_BYTES:])
    need(header in sent_header, "the header on the wire is another")
    need(numbers == layers_of(records), "the wire has not each layer of the file once, in order")
    need(b"".join(sent) == records, "the records on the wire differ from the file")
    need(END in kinds, "the job was not ended")
    need(len(records) >= 10_000_000, f"{len(records)} bytes of records are less than 10 MB")
    digest = hashlib.sha256(records).hexdigest()[:16]
    print(f"wire = spool: {len(records)} bytes of {len(numbers)} layers, sha256 {digest}...; "
          f"{len(stream)} bytes in {transfers} bulk transfers and {len(kinds)} frames")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        main(*sys.argv[1:])
    except Mismatch as wrong:
        sys.exit(f"compare: {wrong}")
