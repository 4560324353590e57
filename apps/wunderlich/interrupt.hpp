/// Ctrl-C and termination as a question the work asks itself.
#pragma once

namespace wunderlich::app {

/// From now on SIGINT and SIGTERM only set a flag. A second one ends the program at once, as usual.
void catch_interrupts();

bool interrupt_requested();

}  // namespace wunderlich::app
