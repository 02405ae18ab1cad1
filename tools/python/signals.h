// What Python's signals do to work in the compiled half.
#pragma once

#include <functional>

namespace radar::python {

/// Lets handlers of signals run, and throws what they raise: for work without the interpreter's lock. Empty in other
/// threads than the main one, which alone handles signals. The caller has the lock.
std::function<void()> signalsHeeded();

}  // namespace radar::python
