# Unpacks python3-gymnasium of a newer Debian into the present folder, which is empty, with lists of packages of its own:
# nothing is installed, and apt's own lists stay as they are. The mirror is that of the machine.
site=$(apt-get indextargets --format '$(LABEL) $(SITE)' 'Created-By: Packages' | sed -n 's/^Debian //p' | head -n 1)
[ -n "$site" ] || exit 1
mkdir -p etc/apt/preferences.d lists/partial archives/partial
touch status
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $site forky main" >sources.list
own() {
  timeout 120 apt-get -qq -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=- -o Dir::State::Lists="$PWD/lists" \
    -o Dir::State::Status="$PWD/status" -o Dir::Cache="$PWD" -o Acquire::Languages=none -o Acquire::Retries=0 \
    -o Acquire::http::Timeout=5 -o APT::Update::Post-Invoke-Success::= -o APT::Sandbox::User="$(id -un)" "$@"
}
own update && own download python3-gymnasium && dpkg -x python3-gymnasium_*.deb .
