#!/bin/sh
# Writes Blender's scene again with assimp 5.2.5 (Debian 12: apt-get install assimp-utils). Its binary FBX is broken: assimp and Blender cannot read it either.
set -e
cd "$(dirname "$0")"
scene=../blender/scene.z-up.glb
assimp export $scene assimp.glb -fglb2
assimp export $scene assimp.obj -fobj
assimp export $scene assimp.ply -fply
assimp export $scene assimp.binary.ply -fplyb
assimp export $scene assimp.fbx -ffbxa
assimp export $scene assimp.stl -fstl
assimp export $scene assimp.binary.stl -fstlb
