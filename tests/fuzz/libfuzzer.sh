#!/bin/bash
# libfuzzer.sh CLANG SOURCE RUNS LIBRARY...: compiles the reader of scenes with clang's libFuzzer and AddressSanitizer and gives it RUNS
# inputs, 5 s and 500 MB at most. The libraries behind it are those of the build.
set -eu
clang=$1 source=$2 runs=$3
shift 3
rm -rf work && mkdir -p work/corpus && cd work
flags=(-std=c++20 -O1 -g -fsanitize=fuzzer,address -march=native -mno-avx512f -DFMT_SHARED -I"$source/include" -isystem /usr/include/eigen3)
for file in "$source"/tests/fuzz/libfuzzer.cpp "$source"/src/scene/*.cpp "$source"/src/core/{text,error}.cpp; do
  "$clang" "${flags[@]}" -c "$file"
done
# Of what is compiled here the libraries have another copy in a larger piece, whose rest is needed: the first one counts.
"$clang" "${flags[@]}" -Wl,-z,muldefs ./*.o "$@" -o fuzz
cp "$source"/drivers/scenes/*.yaml "$source"/tests/scene/good/*.yaml corpus
./fuzz -runs="$runs" -seed=1 -timeout=5 -rss_limit_mb=500 -max_len=4000 -detect_leaks=0 -print_final_stats=1 corpus
