/// For tests of what is refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "wunderlich/base/error.hpp"

namespace wunderlich::testing {

/// The message of the InputError that `call` must throw.
template <class Call>
std::string input_error(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError";
  return "";
}

}  // namespace wunderlich::testing
