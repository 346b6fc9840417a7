#!/usr/bin/env bash
# faults.sh BUILD: documents and rules that check.sh must refuse, and what it says of each.
set -euo pipefail
build=$1
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
rm -rf tree && mkdir -p tree/docs tree/tests

# refused WHAT DOCUMENT RULES: says WHAT.
refused() {
  printf '%s\n' "$2" >tree/docs/a.md
  printf '# none\n' >tree/README.md
  printf '%s\n' "$3" >tree/rules.txt
  local status=0
  "$here/check.sh" tree "$build" tree/rules.txt >said.txt 2>&1 || status=$?
  [[ $status != 0 ]] && grep -qF -- "$1" said.txt || {
    echo "expected a refusal that says '$1', got status $status: $(cat said.txt)" >&2
    exit 1
  }
}
run='    orbweaver systems'
rule='a :: orbweaver systems :: never :: a reason'
refused 'docs/a.md:3: a block without a language' $'text\n\n```\norbweaver systems\n```\n\n'"$run" "$rule"
refused "docs/a.md:4: beside commands: 'obweaver show'" $'text\n\n'"$run"$'\n    obweaver show' "$rule"
refused 'no command of a document is meant by a :: orbweaver show' "$run" $'a :: orbweaver show :: never :: a reason'
refused 'there is no CTest system.nothing' "$run" 'a :: * :: elsewhere :: system.nothing'
refused 'expected DOCUMENT :: PATTERN :: VERB :: TEXT' "$run" 'a :: * :: sometimes :: a reason'
refused 'no commands in' 'text' ''
printf '%s\n' "$run" '    orbweaver show \' '      ATLAS  # a comment' >tree/docs/a.md
printf '%s\n' "$rule" >tree/rules.txt
"$here/check.sh" tree "$build" tree/rules.txt >said.txt  # a grep that ends at its line would kill it by SIGPIPE
grep -qx 'run: 1' said.txt || { echo "what is right is refused" >&2 && exit 1; }

# What follow.sh does with commands: in order, with their files, and it ends at the first that fails.
mkdir -p atlas
cat >tree/b.md <<'END'
```python said.py
print("the file")
```

    cp said.py copied.py   # a comment
    tests/none.sh
    orbweaver systems
END
status=0
"$here/follow.sh" "$PWD/tree/b.md" "$build" "$PWD/atlas" >said.txt 2>&1 || status=$?
[[ $status == 1 ]] && grep -q "line 6: 'tests/none.sh' ended with status 127" said.txt && [[ -s work/copied.py ]] &&
  grep -q 'the file' work/said.txt && ! grep -q 'orbweaver systems' said.txt ||
  { echo "expected the second command to end it, got status $status: $(cat said.txt)" >&2 && exit 1; }
printf '%s\n' '    echo from' '' '```text' 'row  value' '  0  1.5e-15' '```' >tree/c.md
# excerpt STATUS ROW: what follow.sh says of that excerpt where ROW was printed.
excerpt() {
  printf '#!/bin/sh\nprintf "row     value\\n%s\\n"\n' "$2" >tree/table.sh
  sed -i "1s|.*|    bash $PWD/tree/table.sh|" tree/c.md
  status=0
  "$here/follow.sh" "$PWD/tree/c.md" "$build" "$PWD/atlas" >said.txt 2>&1 || status=$?
  [[ $status == "$1" ]] && { [[ $status == 0 ]] || grep -q 'line 3: the excerpt is not what was said' said.txt; } ||
    { echo "an excerpt beside '$2': status $status: $(cat said.txt)" >&2 && exit 1; }
}
excerpt 0 '  0  -2.5e-16'
excerpt 1 '  1  1.5e-15'
echo "all refused"
