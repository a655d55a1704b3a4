//Maya ASCII 2018 scene
//Name: surface_emitter.ma
//Codeset: 1252
requires maya "2018";
currentUnit -l centimeter -a degree -t film;
createNode transform -n "lawn";
	setAttr ".s" -type "double3" 4 4 4 ;
createNode mesh -n "lawnShape" -p "lawn";
	setAttr -k off ".v";
createNode pointEmitter -n "emitter1" -p "lawn";
	setAttr ".emt" 2;
	setAttr ".rat" 50;
createNode transform -n "nParticle1";
createNode nParticle -n "nParticleShape1" -p "nParticle1";
	addAttr -ci true -sn "lifespan" -ln "lifespan" -at "double";
	setAttr ".lifespan" 1;
createNode nucleus -n "nucleus1";
createNode polyPlane -n "polyPlane1";
	setAttr ".cuv" 2;
createNode geoConnector -n "geoConnector1";
connectAttr "polyPlane1.out" "lawnShape.i";
connectAttr ":time1.o" "nucleus1.cti";
connectAttr ":time1.o" "emitter1.ct";
connectAttr "geoConnector1.ocl" "emitter1.t";
connectAttr "nParticleShape1.ifl" "emitter1.full[0]";
connectAttr "nParticleShape1.tss" "emitter1.dt[0]";
connectAttr "nParticleShape1.inh" "emitter1.inh[0]";
connectAttr "nParticleShape1.stt" "emitter1.stt[0]";
connectAttr "nParticleShape1.sd[0]" "emitter1.sd[0]";
connectAttr "emitter1.ot[0]" "nParticleShape1.npt[0]";
connectAttr "nParticleShape1.cust" "nucleus1.niao[0]";
connectAttr "nParticleShape1.stst" "nucleus1.nias[0]";
connectAttr "nucleus1.noao[0]" "nParticleShape1.nxst";
connectAttr "nucleus1.stf" "nParticleShape1.stf";
connectAttr ":time1.o" "nParticleShape1.cti";
// End of surface_emitter.ma
