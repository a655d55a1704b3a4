//Maya ASCII 2018 scene
requires maya "2018";
currentUnit -l centimeter -a degree -t film;
createNode transform -n "ball";
	setAttr ".t" -type "double3" 0 1 0 ;
createNode mesh -n "ballShape" -p "ball";
createNode polySphere -n "polySphere1";
	setAttr ".r" 2;
connectAttr "polySphere1.out" "ballShape.i";
