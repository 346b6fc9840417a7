#!/usr/bin/env bash
# reference.sh DOCUMENT PROGRAM WORD [--renew]: what stands in DOCUMENT behind its line <!-- orbweaver manual WORD --> must be what
# `PROGRAM manual WORD` prints. With --renew it is written there.
set -euo pipefail
document=$1 program=$2 word=$3
mark="<!-- orbweaver manual $word -->"
grep -qxF -- "$mark" "$document" || { echo "$document: expected a line $mark" >&2 && exit 1; }
reference=$("$program" manual "$word")
before=$(sed "/^$mark\$/q" "$document")
if [[ "${4:-}" == --renew ]]; then
  printf '%s\n\n%s\n' "$before" "$reference" >"$document"
  exit
fi
diff <(printf '%s\n\n%s\n' "$before" "$reference") "$document" && exit
echo "$document is not what \`orbweaver manual $word\` prints: tests/documents/reference.sh $document PROGRAM $word --renew" >&2
exit 1
