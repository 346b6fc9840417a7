#pragma once

namespace orbweaver::drivers {

/// An extension of the processor that the compiler was allowed to use.
struct ProcessorExtension {
  const char* name;
  bool compiled_in;
};

/// By the flags of the rest of the program; ends with a null name. Data alone: reading it needs none of them.
extern const ProcessorExtension processor_extensions[];

}  // namespace orbweaver::drivers
