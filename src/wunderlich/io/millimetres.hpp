/// What printers and cutters count in.
#pragma once

namespace wunderlich::io {

inline constexpr double mm = 1000;  ///< per metre

}  // namespace wunderlich::io
