#!/bin/sh
# The real bench_queue, with its real messages, on a simulated cluster (SimGrid's SMPI, Debian: libsimgrid-dev):
#   simulate.sh RANKS FOLDER [options of bench_queue]
# Builds into FOLDER when nothing is there. The program runs here, one rank at a time; what it computes is measured and
# counts as simulated time, messages cost what the platform says (10 GB/s, 1 us a link), sleeps cost nothing.
set -eu
ranks=$1
folder=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
root=$here/../../..
mkdir -p "$folder"
if [ ! -x "$folder/bench_queue" ]; then
  smpicxx -std=c++20 -O2 -DSPDLOG_COMPILED_LIB -DSPDLOG_FMT_EXTERNAL -I"$root/include" -include "$here/clock.hpp" \
    "$here/clock.cpp" "$here"/../bench_queue.cpp "$here"/../task_table.cpp "$root"/src/queue/*.cpp \
    "$root"/src/core/mpi/check_mpi.cpp "$root"/src/core/mpi/collective.cpp "$root"/src/core/mpi/communicator.cpp \
    "$root"/src/core/error.cpp "$root"/src/core/interruption.cpp "$root"/src/core/serialization.cpp \
    "$root"/src/core/styled.cpp "$root"/src/core/terminal.cpp "$root"/src/core/text.cpp "$root"/src/core/log/*.cpp \
    -o "$folder/bench_queue" -lboost_serialization -lz -lspdlog -lfmt
fi
cat > "$folder/platform-$ranks.xml" <<END
<?xml version='1.0'?>
<!DOCTYPE platform SYSTEM "https://simgrid.org/simgrid.dtd">
<platform version="4.1">
  <cluster id="c" prefix="n" suffix="" radical="0-$((ranks - 1))" speed="10Gf" bw="10GBps" lat="1us"/>
</platform>
END
seq -f "n%g" 0 $((ranks - 1)) > "$folder/hosts-$ranks"
# host-speed: computing takes as long there as here. A probe or a test that finds nothing costs 1 us and 0.1 us.
exec smpirun -np "$ranks" -platform "$folder/platform-$ranks.xml" -hostfile "$folder/hosts-$ranks" \
  --cfg=smpi/host-speed:10Gf --cfg=smpi/iprobe:1e-6 --cfg=smpi/test:1e-7 --cfg=smpi/grow-injected-times:no --cfg=smpi/cpu-threshold:1e-7 \
  --cfg=smpi/send-is-detached-thresh:100000000 --cfg=smpi/privatization:no --cfg=contexts/stack-size:512 \
  --log=xbt_cfg.thres:warning "$folder/bench_queue" "$@"
