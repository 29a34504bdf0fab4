#!/bin/sh
# Sets up, builds and runs a scene: sh apps/run.sh [scene.toml] [options of spume run]
set -eu
here=$(dirname "$0")
scene=$here/../data/scenes/pouring.toml
case ${1-} in
  '' | -*) ;;
  *) scene=$1; shift ;;
esac
sh "$here/setup.sh"
sh "$here/build.sh" spume
exec "$here/../build/apps/spume" run "$scene" "$@"
