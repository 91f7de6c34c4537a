// Arguments that arrive as keywords: conversion by pybind11's rules, TypeError for wrong types, and
// tables of arguments by name.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "troffer/types.h"

namespace troffer::bindings {

// The value as a T; TypeError names the argument.
template <class T>
T taken(const pybind11::handle& value, const std::string& name) {
  pybind11::detail::make_caster<T> caster;
  if (!caster.load(value, true))
    throw pybind11::type_error(
        "argument '" + name + "' has the wrong type: " + pybind11::repr(value).cast<std::string>());
  return pybind11::detail::cast_op<T>(std::move(caster));
}

// Strict: True or False, not any object that has a truth value.
template <>
bool taken<bool>(const pybind11::handle& value, const std::string& name);

// Three numbers, or one for all channels.
api::Color color_taken(const pybind11::handle& value, const std::string& name);

// One function per argument, which sets a part of the options.
template <class Options>
using ArgumentTable = std::map<std::string, std::function<void(Options&, const pybind11::handle&)>>;

// An entry of a table: sets a member by taken().
template <class Options, class T>
typename ArgumentTable<Options>::value_type argument(const std::string& name, T Options::*member) {
  return {name, [name, member](Options& o, const pybind11::handle& value) {
            o.*member = taken<T>(value, name);
          }};
}

// Sets an option where the table has the name; else returns false.
template <class Options>
bool set_argument(const ArgumentTable<Options>& table, const std::string& name,
                  const pybind11::handle& value, Options& options) {
  const auto entry = table.find(name);
  if (entry == table.end()) return false;
  entry->second(options, value);
  return true;
}

}  // namespace troffer::bindings
