# Part of ./dev windows: what mjarm stands on there, in .deps/windows. Sourced after setup.sh, never run.
#
# Headers come from the packages that are installed here; libraries are built from the sources of the same Debian
# release, which apt checks by its signatures.

windows=$deps/windows
windows_mujoco=$windows/mujoco-core-4.0.1
windows_packages="g++-mingw-w64-x86-64-posix mingw-w64-tools libz-mingw-w64-dev xz-utils dpkg-dev zip"
windows_sources="cairo fmtlib glfw3 googletest libpng1.6 pixman spdlog tinyxml2 yaml-cpp"

# fetch_sources FOLDER: the sources of Debian, unpacked there, each in a folder that begins with its name.
fetch_sources() {
  local folder=$1 release archive apt
  release=$(. /etc/os-release && echo "$VERSION_CODENAME")
  mkdir -p "$folder/lists/partial"
  echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $(apt-get indextargets \
    --format '$(REPO_URI)' 'Created-By: Packages' "Codename: $release" | sed q) $release main" >"$folder/sources.list"
  apt=(apt-get -q -o "Dir::Etc::SourceList=$folder/sources.list" -o Dir::Etc::SourceParts=/dev/null
    -o "Dir::State::Lists=$folder/lists" -o APT::Sandbox::User=root)
  "${apt[@]}" update || return
  (cd "$folder" && "${apt[@]}" source --download-only --tar-only $windows_sources) || return
  for archive in "$folder"/*.orig.tar.*; do
    tar xf "$archive" -C "$folder" && rm "$archive" || return
  done
}

# with_cmake FOLDER OPTIONS...: builds and installs one library.
with_cmake() {
  local source=$1
  shift
  cmake -S "$source" -B "$source/build-windows" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$root/cmake/windows.cmake" \
    -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX="$windows" -DBUILD_SHARED_LIBS=OFF "$@" &&
    ninja -C "$source/build-windows" -j "$(jobs_at_once)" && ninja -C "$source/build-windows" install
}

# with_configure FOLDER OPTIONS...: the same for those that know no CMake.
with_configure() {
  local source=$1
  shift
  (cd "$source" && PKG_CONFIG_LIBDIR="$windows/lib/pkgconfig" \
    CC=x86_64-w64-mingw32-gcc-posix CFLAGS="-O2 -w -I$windows/include" LDFLAGS="-L$windows/lib" \
    ./configure --host=x86_64-w64-mingw32 --prefix="$windows" --disable-shared --enable-static "$@" &&
    make -j "$(jobs_at_once)" && make install)
}

# Headers that are the same for every system, with what CMake needs to find them.
copy_headers() {
  local package file
  mkdir -p "$windows/include" "$windows/lib"
  for package in libeigen3-dev libexpected-dev nlohmann-json3-dev libcli11-dev; do
    dpkg -L "$package" | grep -E '^/usr/(include|share/(cmake|eigen3))/' | while read -r file; do
      [[ -d $file ]] || install -D -m 644 "$file" "$windows/${file#/usr/}"
    done
  done
  cp -r /usr/include/boost "$windows/include/" &&
    cp -r "/usr/include/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/curl" "$windows/include/" &&
    cp /usr/x86_64-w64-mingw32/include/z{lib,conf}.h "$windows/include/" &&
    cp /usr/x86_64-w64-mingw32/lib/libz.a "$windows/lib/"
}

# Words that go along with what is linked into the program.
copy_licences() {
  local package
  for package in libcairo2-dev libpixman-1-dev libfmt-dev libspdlog-dev libtinyxml2-dev libyaml-cpp-dev libglfw3-dev \
    libpng-dev libz-mingw-w64-dev libeigen3-dev libexpected-dev nlohmann-json3-dev libcli11-dev libboost-dev \
    gcc-mingw-w64-base mingw-w64-common; do
    install -D -m 644 "/usr/share/doc/$package/copyright" "$windows/licences/$package.txt" || return
  done
}

build_libraries() {
  local from=$1
  copy_headers && copy_licences &&
    with_cmake "$from"/fmt* -DFMT_TEST=OFF -DFMT_DOC=OFF &&
    with_cmake "$from"/spdlog* -DSPDLOG_FMT_EXTERNAL=ON -DSPDLOG_BUILD_EXAMPLE=OFF -DSPDLOG_BUILD_TESTS=OFF &&
    with_cmake "$from"/tinyxml2* -Dtinyxml2_BUILD_TESTING=OFF &&
    with_cmake "$from"/yaml-cpp* -DYAML_CPP_BUILD_TESTS=OFF -DYAML_CPP_BUILD_TOOLS=OFF -DYAML_CPP_BUILD_CONTRIB=OFF &&
    with_cmake "$from"/googletest* &&
    with_cmake "$from"/glfw* -DGLFW_BUILD_EXAMPLES=OFF -DGLFW_BUILD_TESTS=OFF -DGLFW_BUILD_DOCS=OFF &&
    with_cmake "$from"/libpng* -DPNG_SHARED=OFF -DPNG_TESTS=OFF &&
    with_configure "$from"/pixman* --disable-gtk --disable-libpng --disable-openmp &&
    with_configure "$from"/cairo* --disable-xlib --disable-ft --disable-fc --disable-ps --disable-pdf --disable-svg \
      --disable-script --disable-interpreter --disable-png --disable-gobject --disable-trace --disable-valgrind
}

# The library of the wheel, and what MinGW-w64 links against in its place.
fetch_windows_mujoco() {
  deps=$windows fetch_wheel mujoco-core 4.0.1 e6bdf0b7a4d7381ff199b0172f192d2a2c79dc31d48dabb8d8121863554a8f8a \
    "mujoco/mujoco.dll mujoco/include/* mujoco_core-*/licenses/*" \
    --python-version 311 --implementation cp --abi cp311 --platform win_amd64 || return
  (cd "$windows_mujoco/mujoco" && quiet gendef mujoco.dll &&
    x86_64-w64-mingw32-dlltool -d mujoco.def -l libmujoco.dll.a)
}

# Does nothing where all is there.
set_up_windows() {
  local work
  set_up_packages $windows_packages
  mkdir -p "$windows"
  if [[ ! -e $windows_mujoco/mujoco/libmujoco.dll.a ]]; then
    step "MuJoCo 4.0.1 for Windows: downloading" fetch_windows_mujoco || die "no MuJoCo for Windows"
  fi
  [[ -e $windows/.whole ]] && return
  work=$(mktemp -d "$deps/sources.XXXXXX")
  step "Libraries for Windows: downloading" quiet fetch_sources "$work" &&
    step "Libraries for Windows: building (a few minutes)" quiet build_libraries "$work" ||
    die "the libraries for Windows could not be built; their sources are in $work"
  rm -rf "$work"
  touch "$windows/.whole"
}
