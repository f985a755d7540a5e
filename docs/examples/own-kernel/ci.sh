#!/bin/sh
# In a plain debian:12: the kernel's bits on processors' drivers for each backend, and whether a change made it slower.
#   TOPPLE_URL  a repository of topple     BASE  the commit to compare with; none: only the bits
set -eu
apt-get update -qq
apt-get install -y -qq --no-install-recommends ca-certificates git g++ cmake ninja-build python3 glslang-tools \
    libvulkan-dev mesa-vulkan-drivers ocl-icd-opencl-dev opencl-headers pocl-opencl-icd libgtest-dev
git config --global --add safe.directory "$PWD"

git clone --depth 1 "${TOPPLE_URL:?is the address of a repository of topple}" build/topple
cmake -S build/topple -B build/topple/build -G Ninja -DTOPPLE_ONLY=kernels
cmake --build build/topple/build
cmake --install build/topple/build --prefix build/prefix

built() {
    cmake -S "$1" -B "$2" -G Ninja -DCHECKS=ON -DCMAKE_PREFIX_PATH="$PWD/build/prefix"
    cmake --build "$2"
}
built . build/change
TOPPLE_REQUIRE_BACKENDS=1 build/change/checks/smooth_test
build/change/checks/my_perf perf --backend native,opencl,vulkan --runs 3 --filter smooth --no-roofline

if [ -n "${BASE:-}" ]; then
    git fetch --depth 1 origin "$BASE"
    git worktree add --force --detach build/base-source "$BASE"
    built build/base-source build/base
    build/change/checks/my_perf compare build/base/checks/my_perf --backend all
fi
