#!/usr/bin/env bash
# Makes library.js and licenses.txt anew, from the npm registry. Only needed to take other versions of the libraries
# or to use more of them: both files are part of the repository, and building Lightwell needs neither npm nor a network.
set -euo pipefail
cd "$(dirname "$0")"
three=0.187.0 bvh=0.9.17 esbuild=0.28.2

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp library.entry.js "$folder/entry.js"
cd "$folder"
npm init -y >/dev/null
npm install --no-audit --no-fund "three@$three" "three-mesh-bvh@$bvh" "esbuild@$esbuild"
npx esbuild entry.js --bundle --minify --format=iife --global-name=Library --legal-comments=none \
  --target=es2020 --charset=ascii --outfile=library.js
! grep -qi '</script' library.js || { echo "library.js cannot stand in a script element" >&2; exit 1; }
{
  for name in three three-mesh-bvh; do
    printf '%s %s\n\n' "$name" "$(node -p "require('./node_modules/$name/package.json').version")"
    cat "node_modules/$name/LICENSE"
    printf '\n\n'
  done
} >licenses.txt
cd - >/dev/null
cp "$folder/library.js" "$folder/licenses.txt" .
