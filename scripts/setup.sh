# Sourced by ./run and ./test: finds or installs what they need, and says in one sentence what
# it cannot install. Quick when everything is there.

say() { printf '\033[1m%s\033[0m\n' "$*" >&2; }

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

have() { command -v "$1" >/dev/null 2>&1; }

as_root() {
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif have sudo; then
    sudo "$@"
  else
    return 1
  fi
}

# Runs a command and shows what it printed only if it failed: installers are wordy.
quietly() {
  local log
  log=$(mktemp)
  if ! "$@" >"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

apt_install() {
  as_root apt-get update -q &&
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -qy --no-install-recommends "$@"
}

# install_packages COMMAND PACKAGE...: system packages by the machine's own package manager.
# A package may be written "debian|fedora|arch|alpine|brew" where the names differ.
install_packages() {
  local needed=$1 spec
  shift
  local apt=() dnf=() pacman=() apk=() brew=()
  for spec in "$@"; do
    local names
    IFS='|' read -r -a names <<<"$spec"
    apt+=("${names[0]}")
    dnf+=("${names[1]:-${names[0]}}")
    pacman+=("${names[2]:-${names[0]}}")
    apk+=("${names[3]:-${names[0]}}")
    brew+=("${names[4]:-${names[0]}}")
  done
  say "Installing ${*%%|*} ..."
  if have apt-get; then
    quietly apt_install "${apt[@]}"
  elif have dnf; then
    quietly as_root dnf install -qy "${dnf[@]}"
  elif have pacman; then
    quietly as_root pacman -Sy --noconfirm --needed "${pacman[@]}"
  elif have apk; then
    quietly as_root apk add -q "${apk[@]}"
  elif have brew; then
    quietly brew install -q "${brew[@]}"
  else
    false
  fi || fail "'$needed' is missing and could not be installed: please install ${*%%|*} and start again."
}

setup_rust() {
  [ "${OS:-}" = Windows_NT ] || have cc || install_packages cc "build-essential|gcc|base-devel|build-base|gcc"
  export PATH="$PATH:${CARGO_HOME:-$HOME/.cargo}/bin"
  if ! have rustup; then
    have curl || install_packages curl curl
    say "Installing Rust by rustup ..."
    local installer
    installer=$(mktemp)
    { curl -sSf --proto '=https' --tlsv1.2 https://sh.rustup.rs -o "$installer" ||
      curl -sSf --proto '=https' --tlsv1.2 https://static.rust-lang.org/rustup/rustup-init.sh -o "$installer"; } 2>/dev/null &&
      quietly sh "$installer" -y --no-modify-path --profile minimal --default-toolchain none ||
      fail "Rust is missing and rustup could not be installed: please install it from https://rustup.rs and start again."
    rm -f "$installer"
  fi
  # Rustup's own cargo, which reads rust-toolchain.toml, comes before one of the system.
  local folder libraries
  folder=$(dirname "$(command -v rustup)")
  [ "$(dirname "$(command -v cargo)")" = "$folder" ] || export PATH="$folder:$PATH"
  # rust-toolchain.toml names the toolchain, its components and its wasm32 target.
  libraries=$(RUSTUP_AUTO_INSTALL=0 rustc --print target-libdir --target wasm32-unknown-unknown 2>/dev/null) || true
  { [ -d "$libraries" ] && has_toolchain; } || install_toolchain rust-toolchain.toml
}

# target_directory [MANIFEST]: where cargo puts what it builds, which its settings may say.
target_directory() {
  cargo metadata --format-version 1 --no-deps --manifest-path "${1:-Cargo.toml}" |
    sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p'
}

# Whether the toolchain of this folder is there.
has_toolchain() {
  { RUSTUP_AUTO_INSTALL=0 cargo fmt --version && RUSTUP_AUTO_INSTALL=0 cargo clippy --version; } >/dev/null 2>&1
}

# Installs the toolchain of this folder, which a file names.
install_toolchain() {
  say "Installing the Rust toolchain of $1 ..."
  quietly rustup toolchain install --no-self-update ||
    fail "The Rust toolchain of $1 could not be installed: is the network reachable?"
}

# The plugins for Bevy need a later Rust than the rest.
setup_bevy() {
  cd integrations/bevy
  has_toolchain || install_toolchain integrations/bevy/rust-toolchain.toml
  cd "$root"
}

node_is_recent() {
  have node && have npm && node -e '
    const [major, minor] = process.versions.node.split(".").map(Number);
    process.exit(major > 20 || (major === 20 && minor >= 19) ? 0 : 1)'
}

setup_node() {
  # A Node.js of our own from an earlier start, where the system's was too old.
  export PATH="$root/.tools/node_modules/.bin:$PATH"
  if ! node_is_recent; then
    have npm || install_packages npm "nodejs|nodejs|nodejs|nodejs|node" "npm|npm|npm|npm|node"
    if ! node_is_recent; then
      say "Installing a Node.js of version 22 into .tools/ ..."
      npm install --silent --no-save --prefix "$root/.tools" node@22 npm@11 >&2 ||
        fail "Node.js 20.19 or later is missing and could not be installed: please install it and start again."
      hash -r
    fi
    node_is_recent || fail "Node.js 20.19 or later is needed, but 'node' here is $(node --version)."
  fi
  node_packages "$root" "Node packages"
}

# node_packages FOLDER WHAT: what a folder's package-lock.json names, if it is not there.
node_packages() {
  local folder=$1 what=$2 installed=$1/node_modules/.package-lock.json
  if [ ! -f "$installed" ] || [ "$folder/package-lock.json" -nt "$installed" ]; then
    say "Installing $what ..."
    npm ci --silent --no-fund --no-audit --prefix "$folder" >&2 ||
      fail "$what could not be installed: is the network reachable?"
    touch "$installed"
  fi
}

# The libraries that the JavaScript package is compared with.
setup_libraries() { node_packages "$root/bench/js" "the alternatives in JavaScript"; }

setup_chromium() {
  local name
  for name in "${CHROMIUM:-}" chromium chromium-browser google-chrome; do
    if [ -n "$name" ] && have "$name"; then
      CHROMIUM=$(command -v "$name")
      export CHROMIUM
      return
    fi
  done
  install_packages chromium chromium
  CHROMIUM=$(command -v chromium) || fail "Chromium was installed but cannot be found: set CHROMIUM to its path."
  export CHROMIUM
}

# Vulkan in software (Mesa's lavapipe), for the tests of what runs on a GPU.
setup_vulkan() {
  compgen -G '/usr/share/vulkan/icd.d/*.json' >/dev/null ||
    install_packages Vulkan "mesa-vulkan-drivers|mesa-vulkan-drivers|vulkan-swrast|mesa-vulkan-swrast|molten-vk"
  # The program that loads drivers.
  compgen -G '/usr/lib*/libvulkan.so.1' >/dev/null || compgen -G '/usr/lib/*/libvulkan.so.1' >/dev/null ||
    compgen -G "${HOMEBREW_PREFIX:-/opt/homebrew}/lib/libvulkan.*" >/dev/null ||
    install_packages Vulkan "libvulkan1|vulkan-loader|vulkan-icd-loader|vulkan-loader|vulkan-loader"
}

# Two compilers with sanitizers, Valgrind, and what finds an installed package.
setup_c() {
  have gcc || install_packages gcc "build-essential|gcc|gcc|gcc|gcc"
  have clang || install_packages clang clang
  if ! echo 'int main(void) { return 0; }' | clang -fsanitize=address,undefined -x c - -o /dev/null 2>/dev/null; then
    # Debian has the sanitizers of clang in a package of its own.
    local version
    version=$(clang -dumpversion)
    install_packages "clang -fsanitize=address" "libclang-rt-${version%%.*}-dev|compiler-rt|compiler-rt|compiler-rt|llvm"
  fi
  have valgrind || install_packages valgrind valgrind
  have cmake || install_packages cmake cmake
  have pkg-config || install_packages pkg-config "pkg-config|pkgconf|pkgconf|pkgconf|pkgconf"
  pkg-config --exists bullet || install_packages bullet "libbullet-dev|bullet-devel|bullet|bullet-dev|bullet"
  pkg-config --exists fcl || install_packages fcl "libfcl-dev|fcl-devel|fcl|fcl-dev|fcl"
}

# A Python with what python/requirements.txt names, of our own: nothing is installed outside.
setup_python() {
  python_environment python "$root/python/requirements.txt"
  export VIRTUAL_ENV=$root/.tools/python PATH="$root/.tools/python/bin:$PATH"
}

# What builds and checks the Python package of a release: the programs of scripts/requirements.txt.
setup_release() {
  python_environment release "$root/scripts/requirements.txt"
  export PATH="$PATH:$root/.tools/release/bin:$root/.tools/release/Scripts"
}

# What checks the workflows and the conda recipe. Not every system on which wheels are built has it.
setup_checks() {
  python_environment checks "$root/tests/requirements.txt"
  export PATH="$PATH:$root/.tools/checks/bin"
}

# python_environment NAME REQUIREMENTS: an environment in .tools/NAME with what the file names.
python_environment() {
  local folder=$root/.tools/$1 wanted=$2 installed programs=bin
  installed=$folder/requirements.txt
  [ "${OS:-}" != Windows_NT ] || programs=Scripts
  if ! "$folder/$programs/python" -c '' 2>/dev/null; then
    python3 -c 'import ensurepip, venv' 2>/dev/null ||
      install_packages python3 "python3-venv|python3|python|python3|python"
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' ||
      fail "Python 3.11 or later is needed, but 'python3' here is $(python3 --version)."
    rm -rf "$folder"
    python3 -m venv "$folder" || fail "An environment for Python could not be made in .tools/$1."
  fi
  if ! cmp -s "$wanted" "$installed"; then
    say "Installing what ${wanted#"$root/"} names into .tools/$1 ..."
    quietly "$folder/$programs/python" -m pip install --quiet --disable-pip-version-check --requirement "$wanted" ||
      fail "The Python packages could not be installed: is the network reachable?"
    cp "$wanted" "$installed"
  fi
}

# Checks the workflows of GitHub Actions. Written in Go, and not published as a package elsewhere.
setup_actionlint() {
  local version=1.7.12 installed
  export PATH="$root/.tools/bin:$PATH"
  installed=$(actionlint -version 2>/dev/null) || true
  [[ $installed != *"$version"* ]] || return 0
  have go || install_packages go "golang-go|golang|go|go|go"
  say "Installing actionlint into .tools/bin ..."
  GOBIN=$root/.tools/bin quietly go install "github.com/rhysd/actionlint/cmd/actionlint@v$version" ||
    fail "actionlint could not be installed: is the network reachable, and is 'go' 1.25 or later?"
}

# Checks licenses, sources and known vulnerabilities of the crates that we depend on.
setup_cargo_deny() {
  local version=0.20.2
  export PATH="$root/.tools/bin:$PATH"
  [ "$(cargo-deny --version 2>/dev/null)" != "cargo-deny $version" ] || return 0
  say "Installing cargo-deny into .tools/bin ..."
  quietly cargo install --quiet --locked --root "$root/.tools" --version "$version" cargo-deny ||
    fail "cargo-deny could not be installed: is the network reachable?"
}
