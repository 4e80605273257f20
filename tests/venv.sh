# A Python environment with packages from PyPI, for the script that sources this: made once, whole or not at all.

# make_venv_of FOLDER REQUIREMENTS: the packages of a file, installed when the file is another than last time.
make_venv_of() {
    local venv=$1 requirements=$2 wanted
    wanted=$(sha256sum "$requirements")
    [ "$(cat "$venv/installed" 2>/dev/null)" != "$wanted" ] || return 0
    make_venv "$venv" --requirement "$requirements" || return
    echo "$wanted" >"$venv/installed"
}

# make_venv FOLDER PIP-ARGUMENT...: what pip is to install there. Returns 77 where it cannot be had, and says why.
make_venv() {
    local venv=$1 why
    shift
    # Debian's python3 has venv without python3-venv, but not what puts pip into one.
    if ! python3 -c 'import ensurepip, venv' 2>/dev/null; then
        echo "${0##*/}: skipped: no python3 with venv and pip; \`apt-get install python3-venv\` brings them" >&2
        return 77
    fi
    # One without pip is half of one.
    if ! "$venv/bin/python" -c 'import pip' 2>/dev/null; then
        rm -rf "$venv"
        if ! why=$(python3 -m venv "$venv" 2>&1); then
            rm -rf "$venv"
            echo "${0##*/}: skipped: no Python environment: $(tail -n 1 <<<"$why")" >&2
            return 77
        fi
    fi
    if ! why=$("$venv/bin/python" -m pip install --quiet --disable-pip-version-check "$@" 2>&1); then
        echo "${0##*/}: skipped: pip: $(tail -n 1 <<<"$why")" >&2
        echo "it needs a network once, and Python 3.11 or later; this is $("$venv/bin/python" --version)" >&2
        return 77
    fi
}
