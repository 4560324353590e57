/// Bad input: the one kind of failure that is an exception.
#pragma once

#include <stdexcept>
#include <string>

namespace wunderlich {

/// Says what is wrong, where, and what would be right. `what()` is the whole message, ready to print:
/// `file:line:column: key: problem; what is allowed`. The command line turns it into exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace wunderlich
