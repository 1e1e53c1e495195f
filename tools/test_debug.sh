#!/bin/bash
# Builds the libraries by the debug preset, warnings as errors, and runs their unit tests. Without inlining, faults
# show: two types of one name, uninitialised members, failing assertions. Tests that take minutes without optimisation
# are left to the release build: those of the bench, the programs and whole frames, and those of `slow`.
set -euo pipefail
cd "$(dirname "$0")/.."

folders=(base io math parallel trees points scene texture stage visibility shadow soft tint ao query shade)
# Those that take many seconds each: exact answers for whole masks, catalogues, soups, whole frames; and parts of times,
# which are others without optimisation.
slow='ShadowMask\.|NodeTests|SoftCatalogue|SoftCloud|Oracle|Exact|EverySoup|StaysWholeWhenKilled|SoftMetamorphic|SoftError\.|^Sun\.(Agrees|Has)'
slow+='|^TreeBound|^SoftMemory\.|HoweverFine|^Bart|SoftPackets|ShaftFrames|NeverLeaveOut|HandOver|AreaIsThatOf|Tiles\.AreTheSame|Tiles\.WorkOut'
slow+='|DistantFaceBounds|OfHundredsOfEdges|NearlyCoincide|SheetsOf|GivesWhatClipping|FieldAccuracy|FindsABall'
slow+='|AdaptiveOcclusion\.(Meets|SameBits|Stops|DoesNot)|AoCatalogue|AoMemory'
slow+='|^Allocation\.|^Stop\.|^Places\.|EvenEmission|TexturedPanes|RunsAlong|^FieldLookup\.(Never|Gives|Takes|OneField|SeesFrom)|WhatIsDropped'
slow+='|AmbientOcclusion\.(BuiltFields|Follows|Room|StopsAnd|PointsKeep|SameBits|BothLayouts|DoesNotDepend|HalfTheResolution|AtVertices)|RealScenes|DividesNoMore|ManyLarge'
[[ -e build-debug/CMakeCache.txt ]] && first=() || first=(-DTENEBRA_UNITY=ON -DTENEBRA_LEVELS=native)  # as in test.sh
cmake --preset debug -DTENEBRA_TESTS=ON "${first[@]}" -DCMAKE_COMPILE_WARNING_AS_ERROR=ON > /dev/null
cmake --build --preset debug --target "${folders[@]/#/tests_}"
labels=$(IFS='|'; echo "${folders[*]}")
ctest --test-dir build-debug --output-on-failure -j2 -L "^($labels)\$" -E "$slow" "$@"
