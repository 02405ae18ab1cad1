#!/usr/bin/env bash
# Runs the shell commands of docs/ci.md: ci_recipe.sh CI_MD PROGRAM FOLDER.
set -euo pipefail
recipe=$(sed -n '/^```sh$/,/^```$/{/^```/!p}' "$1")
rm -rf "$3"
mkdir -p "$3"
cd "$3"
eval "$recipe"
"$2" devices | tee devices.txt
[ "$(grep -c llvmpipe devices.txt)" -eq 2 ] || { echo "expected two lavapipe devices"; exit 1; }
