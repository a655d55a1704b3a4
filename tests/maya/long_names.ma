//Maya ASCII 8.5 scene
//Codeset: UTF-8
requires maya "8.5";
currentUnit -linear meter -angle radian -time pal;
createNode transform -name "Tuch, groß! (neu)";
	setAttr ".translate" -type "double3" 0 2 0;
	setAttr ".rotate" -type "double3" 0 1.5707963267948966 0;
createNode mesh -name "clothMesh" -parent "Tuch, groß! (neu)";
	setAttr ".intermediateObject" yes;
	setAttr -size 4 ".vrts[0:1]" -1 0 1 1 0 1;
	setAttr ".vrts[2:3]" -1 0
		-1 1 0 -1;
	setAttr -size 5 ".edge[0:4]" 0 1 0 1 3 0 3 2 0
		2 0 0 0 3 1;
	setAttr -size 6 ".normals[0:5]" -type "float3" nan nan nan 0 1 0 0 1 0 0 1 0 0 1 0 0 1 0;
	setAttr -size 2 ".face[0:1]" -type "polyFaces"
		f 3 0 1 -5
		mc 0 3 0 1 2
		f 3 4 2 3 ;
	setAttr ".pnts[1].pntx" 0.01;
createNode transform -name "clothTransform";
createNode nCloth -name "clothShape" -parent "clothTransform";
	setAttr ".stretchResistance" 35 -keyable on;
	setAttr -keyable off ".visibility";
	setAttr ".localForceY" 0.5;
	setAttr ".selfCollide" off;
createNode nucleus -name "solver";
	setAttr ".gravityDirection" -type "double3" 0 0 -1;
connectAttr "time1.outTime" "solver.currentTime" -force;
connectAttr "time1.outTime" "clothShape.currentTime";
connectAttr "|Tuch, groß! (neu)|clothMesh.worldMesh[0]" "clothShape.inputMesh";
connectAttr "clothShape.currentState" "solver.inputActive[3]" -nextAvailable;
connectAttr "clothShape.startState" "solver.inputActiveStart[3]";
connectAttr "solver.outputObjects[3]" "clothShape.nextState";
connectAttr "solver.startFrame" "clothShape.startFrame";
