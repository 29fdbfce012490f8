#pragma once

namespace lightwell {

/// From now on SIGINT and SIGTERM raise a flag instead of ending the program; a second one ends it.
/// Files that reach the size that is allowed fail to be written, with an error as on a full disk.
void catch_interrupts();

/// Whether one of them has arrived.
bool interrupt_requested();

/// Throws Interrupted if one has: for moments between two pieces of work.
void stop_if_interrupted();

}  // namespace lightwell
