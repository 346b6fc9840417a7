/// A shared library of a few kilobytes, of which the kind `plugins` makes its inputs.
extern "C" [[gnu::visibility("default")]] int answer();
extern "C" int answer() { return 42; }
