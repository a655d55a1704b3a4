//Maya ASCII 2018 scene
requires maya "2018";
file -rdi 1 -ns "prop" -rfn "propRN" -op "v=0;" -typ "mayaAscii" "C:/projects/show/scenes/collider.ma";
file -r -ns "prop" -dr 0 -rfn "propRN" -op "v=0;" -typ "mayaAscii" "C:/projects/show/scenes/collider.ma";
file -rdi 1 -ns "gone" -rfn "goneRN" -typ "mayaAscii" "../../../../etc/passwd";
file -r -ns "self" -rfn "selfRN" -typ "mayaAscii" "reference.ma";
currentUnit -l centimeter -a degree -t film;
createNode reference -n "propRN";
	setAttr ".ed" -type "dataReferenceEdits"
		"propRN"
		"propRN" 0
		"propRN" 3
		2 "|prop:ball" "translate" " -type \"double3\" 0 4 0"
		2 "prop:polySphere1" "radius" " 3"
		5 3 "propRN" "|prop:ball|prop:ballShape.worldMesh" "propRN.placeHolderList[1]"
		"";
createNode transform -n "nRigid1";
createNode nRigid -n "nRigidShape1" -p "nRigid1";
createNode nucleus -n "nucleus1";
connectAttr "propRN.phl[1]" "nRigidShape1.imsh";
connectAttr "nRigidShape1.cust" "nucleus1.nipo[0]";
connectAttr "nRigidShape1.stst" "nucleus1.nips[0]";
connectAttr ":time1.o" "nucleus1.cti";
connectAttr ":time1.o" "nRigidShape1.cti";
