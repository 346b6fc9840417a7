#pragma once

#include <string>
#include <string_view>

namespace orbweaver::survey {

// Keys are paths (docs/architecture.md, "Keys"): what they say is read here and nowhere else. They sort, byte by byte,
// as their numbers do: one with more digits than usual has a letter before it, which stands for how many more.

/// "0002" of an equilibrium, "0002.0001" of a base family that begins there: that of its mode 1.
[[nodiscard]] std::string equilibrium_key(int equilibrium);
[[nodiscard]] std::string base_key(int equilibrium, int mode);
/// "0000.0001/003.q4.j1" of the branch "0000.0001": its event number 3; `what` is "q4.j1" or "fold".
[[nodiscard]] std::string event_key(std::string_view branch, int number, std::string_view what);
/// The branch on which the crossing lies.
[[nodiscard]] std::string branch_of(std::string_view crossing);
/// The branch on which the crossing lies where a branch was born; empty for one of a base family.
[[nodiscard]] std::string parent_of(std::string_view branch);
/// Of a branch: 0 for base families, 1 for what is born on them.
[[nodiscard]] int depth_of(std::string_view branch);
/// Whether `key` is that of something found along `branch`: an event, or what was born there, at any depth.
[[nodiscard]] bool lies_on(std::string_view key, std::string_view branch);
/// The number of the event of `branch` on which, or from which, `key` lies. Throws EnvironmentError for a key without
/// one.
[[nodiscard]] int event_number(std::string_view key, std::string_view branch);

/// The index of the equilibrium at which the family, or what it descends from, begins: 2 of "0002.0001/003.q4.j1/0".
[[nodiscard]] int equilibrium_index(std::string_view key);
/// The base family, whatever its side, that the family is or descends from: "0002.0001" of "0002.0001+/003.q4.j1/0".
[[nodiscard]] std::string base_of(std::string_view key);
/// The mode of a base family among those of its equilibrium: "0001" of "0002.0001+".
[[nodiscard]] std::string mode_of(std::string_view base);

/// "locate KEY" and "start KEY": tasks about a crossing or a family, whose branch has the task KEY.
[[nodiscard]] std::string locate_key(std::string_view crossing);
[[nodiscard]] std::string start_key(std::string_view branch);
/// "locus KEY:1": the scene's loci with this number, from a crossing.
[[nodiscard]] std::string locus_key(std::string_view crossing, int entry);
/// The crossing's, family's or branch's KEY of any task, with the number of a locus.
[[nodiscard]] std::string place_of(std::string_view task_key);

}  // namespace orbweaver::survey
