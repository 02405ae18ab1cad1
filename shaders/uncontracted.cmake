cmake_minimum_required(VERSION 3.25)

# Writes to OUT the SPIR-V module IN with each operation on doubles decorated NoContraction, so that no compiler fuses it with another: the
# CPU's bits are those of single operations. glslang decorates only what flows into variables that are `precise`. With ARRAY, writes the
# module also to the header ARRAY, as the array NAME. DIS and AS are spirv-dis and spirv-as. Fails on operations on doubles that it
# does not know, and on those that consist of several, such as a dot product, which drivers may fuse within.

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed ERROR_VARIABLE error)
  if(failed)
    message(FATAL_ERROR "${ARGN}: ${failed}\n${error}")
  endif()
endfunction()

set(simple FNegate FAdd FSub FMul FDiv FRem FMod VectorTimesScalar)
# What moves numbers, or makes them by one operation at most.
set(other AccessChain Bitcast CompositeConstruct CompositeExtract CompositeInsert Constant ConstantComposite ConstantNull ConvertSToF ConvertUToF
  CopyLogical CopyObject FConvert Function FunctionCall FunctionParameter Load Phi Select SpecConstant SpecConstantComposite Transpose
  Undef VectorExtractDynamic VectorInsertDynamic VectorShuffle)
# Of the extended instructions: signs, rounding to integers, the least and greatest, bits.
set(extended Round RoundEven Trunc FAbs FSign Floor Ceil Fract FMin FMax FClamp NMin NMax NClamp PackDouble2x32)

set(text ${OUT}.txt)
run(${DIS} --raw-id --no-header --no-indent --no-color ${IN} -o ${text})
file(READ ${text} module)
set(types "")
if(module MATCHES "(%[0-9]+) = OpTypeFloat 64\n")
  set(types ${CMAKE_MATCH_1})
  foreach(composite Vector Matrix)
    foreach(of ${types})
      string(REGEX MATCHALL "%[0-9]+ = OpType${composite} ${of} [234]\n" lines "${module}")
      foreach(line ${lines})
        string(REGEX MATCH "^%[0-9]+" type ${line})
        list(APPEND types ${type})
      endforeach()
    endforeach()
  endforeach()
endif()
set(decorations "")
foreach(type ${types})
  string(REGEX MATCHALL "%[0-9]+ = Op[A-Za-z]+ ${type}( %[0-9]+ [A-Z][A-Za-z0-9]+| |\n)" lines "${module}")
  foreach(line ${lines})
    string(REGEX MATCH "^(%[0-9]+) = Op([A-Za-z]+) %[0-9]+( %[0-9]+ (.+)|.)$" line "${line}")
    if(CMAKE_MATCH_2 IN_LIST simple)
      string(FIND "${module}" "OpDecorate ${CMAKE_MATCH_1} NoContraction\n" at)
      if(at EQUAL -1)
        string(APPEND decorations "OpDecorate ${CMAKE_MATCH_1} NoContraction\n")
      endif()
    elseif(NOT (CMAKE_MATCH_2 IN_LIST other OR CMAKE_MATCH_2 MATCHES "^Type" OR (CMAKE_MATCH_2 STREQUAL ExtInst AND CMAKE_MATCH_4 IN_LIST extended)))
      message(FATAL_ERROR "${IN}: \"${line}\" on doubles: expected single operations, whose contraction can be forbidden")
    endif()
  endforeach()
endforeach()
# Decorations come before all types.
string(REGEX MATCH "\n%[0-9]+ = OpType" first "${module}")
string(FIND "${module}" "${first}" at)
math(EXPR at "${at} + 1")
string(SUBSTRING "${module}" 0 ${at} head)
string(SUBSTRING "${module}" ${at} -1 tail)
file(WRITE ${text} "${head}${decorations}${tail}")
run(${AS} --target-env vulkan1.3 --preserve-numeric-ids ${text} -o ${OUT})
file(REMOVE ${text})

if(ARRAY)
  file(READ ${OUT} words HEX)
  string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words ${words})
  file(WRITE ${ARRAY} "#pragma once\n#include <cstdint>\ninline constexpr uint32_t ${NAME}[] = {${words}};\n")
endif()
