#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// A task of a survey, as the queue sees it.
struct TaskRow {
  int parent = -1;  ///< the row of the task that made it; -1: there from the beginning
  int priority = 0;
  double seconds = 0.0;
  double silence = 0.0;       ///< longest time without a report (s)
  std::size_t bytes_in = 0;   ///< payload of the task
  std::size_t bytes_out = 0;  ///< payload of its outcome
  std::vector<int> children{};
};

/// Reads what task_table.py writes. Throws std::runtime_error with the line that is wrong.
[[nodiscard]] std::vector<TaskRow> read_task_table(const std::string& file);
/// All seconds of one survey, and those of its longest chain of parents and children.
[[nodiscard]] double total_seconds(const std::vector<TaskRow>& rows);
[[nodiscard]] double chain_seconds(const std::vector<TaskRow>& rows);
